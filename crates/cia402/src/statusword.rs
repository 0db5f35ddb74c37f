//! Status of the drive for the master (6041h).
//!
//! | state | mask | bits 6, 5, 3–0 |
//! |---|---|---|
//! | Not ready to switch on | 004Fh | `0x 0000` |
//! | Switch on disabled | 004Fh | `1x 0000` |
//! | Ready to switch on | 006Fh | `01 0001` |
//! | Switched on | 006Fh | `01 0011` |
//! | Operation enabled | 006Fh | `01 0111` |
//! | Quick stop active | 006Fh | `00 0111` |
//! | Fault reaction active | 004Fh | `0x 1111` |
//! | Fault | 004Fh | `0x 1000` |
use crate::PowerState;
use servobench_base::Stateful;

/// A bit of the statusword.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum StatusBit {
    /// Part of the state.
    ReadyToSwitchOn,
    /// Part of the state.
    SwitchedOn,
    /// Part of the state.
    OperationEnabled,
    /// Part of the state.
    Fault,
    /// The high-level power is applied.
    VoltageEnabled,
    /// Cleared while the drive reacts to a quick stop request; part of the state.
    QuickStop,
    /// Part of the state.
    SwitchOnDisabled,
    /// A warning is present; the state does not change.
    Warning,
    /// Left to the manufacturer.
    ManufacturerSpecific8,
    /// The controlword is processed.
    Remote,
    /// The set-point is reached, or the axis has stopped after a halt.
    TargetReached,
    /// A limit inside the drive is active.
    InternalLimitActive,
    /// Meaning by mode of operation: set-point acknowledge, speed, homing attained, drive follows the command value.
    ModeSpecific12,
    /// Meaning by mode of operation: following error, maximum slippage, homing error.
    ModeSpecific13,
    /// Left to the manufacturer.
    ManufacturerSpecific14,
    /// Left to the manufacturer.
    ManufacturerSpecific15,
}

impl StatusBit {
    const fn mask(self) -> u16 {
        1 << self as u8
    }
}

/// The statusword (6041h): a state and further bits. Any sixteen bits may arrive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Stateful)]
pub struct Statusword(u16);

/// Bits 6 and 3–0: they define a state that leaves bit 5 open.
const MASK_WITHOUT_QUICK_STOP: u16 = 0x004F;
/// Bits 6, 5 and 3–0.
const MASK_WITH_QUICK_STOP: u16 = 0x006F;

impl Statusword {
    /// The word of a state with every other bit cleared, and bit 5 if the state leaves it open.
    #[must_use]
    pub const fn of(state: PowerState) -> Self {
        Self(coding(state).1)
    }

    /// A word received from the bus.
    #[must_use]
    pub const fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// The word as sent over the bus.
    #[must_use]
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// State of the word; `None` if no state has these bits.
    #[must_use]
    pub fn state(self) -> Option<PowerState> {
        PowerState::ALL.into_iter().find(|state| {
            let (mask, value) = coding(*state);
            self.0 & mask == value
        })
    }

    /// True if `bit` is set.
    #[must_use]
    pub const fn has(self, bit: StatusBit) -> bool {
        self.0 & bit.mask() != 0
    }

    /// The word with `bit` set or cleared.
    #[must_use]
    pub const fn with(self, bit: StatusBit, set: bool) -> Self {
        if set { Self(self.0 | bit.mask()) } else { Self(self.0 & !bit.mask()) }
    }
}

/// Mask and value of a state (IEC 61800-7-201, 6041h).
const fn coding(state: PowerState) -> (u16, u16) {
    match state {
        PowerState::NotReadyToSwitchOn => (MASK_WITHOUT_QUICK_STOP, 0x00),
        PowerState::SwitchOnDisabled => (MASK_WITHOUT_QUICK_STOP, 0x40),
        PowerState::ReadyToSwitchOn => (MASK_WITH_QUICK_STOP, 0x21),
        PowerState::SwitchedOn => (MASK_WITH_QUICK_STOP, 0x23),
        PowerState::OperationEnabled => (MASK_WITH_QUICK_STOP, 0x27),
        PowerState::QuickStopActive => (MASK_WITH_QUICK_STOP, 0x07),
        PowerState::FaultReactionActive => (MASK_WITHOUT_QUICK_STOP, 0x0F),
        PowerState::Fault => (MASK_WITHOUT_QUICK_STOP, 0x08),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_published_drives_are_read() {
        // 0237h, 0250h, 0218h: in operation, disabled and faulty with voltage and remote, as manuals print them.
        assert_eq!(Statusword::from_bits(0x0237).state(), Some(PowerState::OperationEnabled));
        assert_eq!(Statusword::from_bits(0x0250).state(), Some(PowerState::SwitchOnDisabled));
        assert_eq!(Statusword::from_bits(0x0218).state(), Some(PowerState::Fault));
        assert_eq!(Statusword::from_bits(0x0217).state(), Some(PowerState::QuickStopActive));
    }

    #[test]
    fn every_state_is_told_by_as_many_words_as_its_mask_leaves_open() {
        for state in PowerState::ALL {
            let words = (0..=u16::MAX).filter(|bits| Statusword::from_bits(*bits).state() == Some(state)).count();
            let free_bits = if has_quick_stop_bit(state) { 10 } else { 11 };
            assert_eq!(words, 1 << free_bits, "{state}");
        }
    }

    #[test]
    fn every_word_that_tells_a_state_is_made_again_from_the_state_and_the_bits_beside_it() {
        for bits in 0..=u16::MAX {
            let word = Statusword::from_bits(bits);
            assert_eq!(word.bits(), bits);
            let Some(state) = word.state() else { continue };
            let mut again = Statusword::of(state);
            for bit in BESIDE_THE_STATE {
                again = again.with(bit, word.has(bit));
            }
            if !has_quick_stop_bit(state) {
                again = again.with(StatusBit::QuickStop, word.has(StatusBit::QuickStop));
            }
            assert_eq!(again, word, "{bits:04X}h");
        }
    }

    #[test]
    fn a_bit_is_cleared_as_it_was_set() {
        for bit in BESIDE_THE_STATE {
            let full = Statusword::from_bits(u16::MAX);
            assert!(full.has(bit) && !full.with(bit, false).has(bit));
            assert_eq!(full.with(bit, false).with(bit, true), full);
        }
        assert_eq!(Statusword::default().with(StatusBit::TargetReached, true).bits(), 0x0400);
    }

    const BESIDE_THE_STATE: [StatusBit; 10] = [
        StatusBit::VoltageEnabled,
        StatusBit::Warning,
        StatusBit::ManufacturerSpecific8,
        StatusBit::Remote,
        StatusBit::TargetReached,
        StatusBit::InternalLimitActive,
        StatusBit::ModeSpecific12,
        StatusBit::ModeSpecific13,
        StatusBit::ManufacturerSpecific14,
        StatusBit::ManufacturerSpecific15,
    ];

    fn has_quick_stop_bit(state: PowerState) -> bool {
        use PowerState::{OperationEnabled, QuickStopActive, ReadyToSwitchOn, SwitchedOn};
        matches!(state, ReadyToSwitchOn | SwitchedOn | OperationEnabled | QuickStopActive)
    }
}
