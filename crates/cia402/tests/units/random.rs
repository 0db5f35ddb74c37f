//! Seeded random counts.
#[path = "../../../motion/tests/shared/random.rs"]
mod shared;

pub(crate) use shared::Random;

impl Random {
    /// A positive number of 1 to `bits` bits, every width alike.
    pub(crate) fn magnitude(&mut self, bits: u32) -> i64 {
        let width = 1 + self.next() % u64::from(bits);
        i64::try_from(self.next() >> (64 - width)).unwrap().max(1)
    }

    /// 1 or −1.
    pub(crate) fn sign(&mut self) -> i128 {
        if self.unit() < 0.5 { 1 } else { -1 }
    }
}
