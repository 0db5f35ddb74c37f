//! Identity of the mechanics to which a saved state belongs.
use crate::engine::EngineName;
use crate::mechanics::MechanicsSetup;
use servobench_base::Stateful;
use servobench_base::state::{Damaged, Reader, Writer};
use std::fmt::{self, Write};

/// Digest of engine, model, actuation and tick of mechanics, the first number in each of their states: only the same mechanics restore it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Identity(u64);

impl Identity {
    /// Identity of the mechanics that `engine` builds by `setup`; states at tick 0 may differ.
    #[must_use]
    pub fn new(engine: EngineName, setup: &MechanicsSetup) -> Self {
        let MechanicsSetup { model, drive, step, initial: _ } = setup;
        let mut digest = Fnv(0xcbf2_9ce4_8422_2325);
        // Debug writes each number with all its digits, and `Fnv` accepts every text.
        let _ = write!(digest, "{engine:?} {model:?} {drive:?} {step:?}");
        Self(digest.0)
    }
}

impl Stateful for Identity {
    fn save(&self, to: &mut dyn Writer) {
        to.word(self.0);
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        if from.word()? == self.0 { Ok(()) } else { Err(Damaged) }
    }
}

/// FNV-1a, 64 bit. Source: RFC 9923, §3.2.
struct Fnv(u64);

impl Write for Fnv {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        Ok(())
    }
}
