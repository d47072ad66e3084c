//! The exports of the WebAssembly module: functions with numeric arguments and results, for one
//! engine.
#![expect(
    unsafe_code,
    reason = "the attribute that keeps a name counts as unsafe; there is no other"
)]

use std::cell::RefCell;
use std::mem;

use crate::Engine;

/// The engine and the buffers that the host reads and writes.
struct Host {
    engine: Engine,
    message: Vec<u8>,
    answer: Vec<u8>,
}

thread_local! {
    static HOST: RefCell<Host> =
        const { RefCell::new(Host { engine: Engine::new(), message: Vec::new(), answer: Vec::new() }) };
}

/// Returns the address of a buffer for a message of `bytes` bytes; 0 if there is not enough memory.
/// The buffer is valid until the next `reserve` or `call`.
#[unsafe(no_mangle)]
extern "C" fn reserve(bytes: usize) -> usize {
    HOST.with_borrow_mut(|host| {
        host.message = Vec::new();
        if host.message.try_reserve_exact(bytes).is_err() {
            return 0;
        }
        host.message.resize(bytes, 0);
        host.message.as_mut_ptr().addr()
    })
}

/// Processes the first `bytes` bytes of the buffer as a message. Returns the address of the
/// response, which is valid until the next `call`.
#[unsafe(no_mangle)]
extern "C" fn call(bytes: usize) -> usize {
    HOST.with_borrow_mut(|host| {
        // The message is freed after the call, since a recording may have hundreds of megabytes.
        let message = mem::take(&mut host.message);
        host.answer = host.engine.call(&message[..bytes.min(message.len())]);
        host.answer.as_ptr().addr()
    })
}

/// Returns the length of the last response in bytes.
#[unsafe(no_mangle)]
extern "C" fn answer_bytes() -> usize {
    HOST.with_borrow(|host| host.answer.len())
}
