//! Prints all hashes in the format of the golden file.

use std::io::{self, Write};

fn main() -> io::Result<()> {
    for check in impinge_wasm::checks() {
        writeln!(io::stdout(), "{} {:016x}", check.name, (check.hash)())?;
    }
    Ok(())
}
