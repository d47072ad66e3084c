//! What the host of the WebAssembly module calls: functions of numbers, and one engine.
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

/// The address of a buffer for a message of so many bytes, which stands until the next call; 0 if there is no memory
/// for it.
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

/// Answers the message in the buffer: the address of the answer, which stays until the next call.
#[unsafe(no_mangle)]
extern "C" fn call(bytes: usize) -> usize {
    HOST.with_borrow_mut(|host| {
        // Freed with the call: that of a recording may have hundreds of megabytes.
        let message = mem::take(&mut host.message);
        host.answer = host.engine.call(&message[..bytes.min(message.len())]);
        host.answer.as_ptr().addr()
    })
}

/// The length of the answer.
#[unsafe(no_mangle)]
extern "C" fn answer_bytes() -> usize {
    HOST.with_borrow(|host| host.answer.len())
}
