//! Commands of the master to the drive (6040h).
//!
//! | command | bits 7, 3–0 | transitions |
//! |---|---|---|
//! | Shutdown | `0 x110` | 2, 6, 8 |
//! | Switch on | `0 x111` | 3, then 4 where bit 3 is set |
//! | Disable voltage | `0 xx0x` | 7, 9, 10, 12 |
//! | Quick stop | `0 x01x` | 7, 10, 11 |
//! | Disable operation | `0 0111` | 5 |
//! | Enable operation | `0 1111` | 4, 16 |
//! | Fault reset | rising edge of bit 7 | 15 |
//!
//! While bit 7 is set, no other command is given.

use servobench_base::Stateful;
/// A bit of the controlword.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum ControlBit {
    /// Part of the commands.
    SwitchOn,
    /// Part of the commands.
    EnableVoltage,
    /// Cleared to request a quick stop; part of the commands.
    QuickStop,
    /// Part of the commands.
    EnableOperation,
    /// Meaning by mode of operation: new set-point, homing operation start, enable interpolation.
    ModeSpecific4,
    /// Meaning by mode of operation: change set immediately.
    ModeSpecific5,
    /// Meaning by mode of operation: absolute or relative.
    ModeSpecific6,
    /// Its rising edge resets a fault.
    FaultReset,
    /// Interrupts the motion as defined by 605Dh, in Operation enabled.
    Halt,
    /// Meaning by mode of operation: change on set-point.
    ModeSpecific9,
    /// Reserved.
    Reserved10,
    /// Left to the manufacturer.
    ManufacturerSpecific11,
    /// Left to the manufacturer.
    ManufacturerSpecific12,
    /// Left to the manufacturer.
    ManufacturerSpecific13,
    /// Left to the manufacturer.
    ManufacturerSpecific14,
    /// Left to the manufacturer.
    ManufacturerSpecific15,
}

impl ControlBit {
    const fn mask(self) -> u16 {
        1 << self as u8
    }
}

/// Command of a controlword to the power state machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Command {
    /// Moves to Ready to switch on.
    Shutdown,
    /// Moves to Switched on.
    SwitchOn,
    /// Moves to Switch on disabled, without power at once.
    DisableVoltage,
    /// Moves to Quick stop active, or to Switch on disabled if the axis is not powered.
    QuickStop,
    /// Moves back to Switched on.
    DisableOperation,
    /// Moves to Operation enabled.
    EnableOperation,
    /// Leaves Fault.
    FaultReset,
}

impl Command {
    /// Every command, in the order of the standard.
    pub const ALL: [Self; 7] = [
        Self::Shutdown,
        Self::SwitchOn,
        Self::DisableVoltage,
        Self::QuickStop,
        Self::DisableOperation,
        Self::EnableOperation,
        Self::FaultReset,
    ];

    /// Name in the words of the standard.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shutdown => "Shutdown",
            Self::SwitchOn => "Switch on",
            Self::DisableVoltage => "Disable voltage",
            Self::QuickStop => "Quick stop",
            Self::DisableOperation => "Disable operation",
            Self::EnableOperation => "Enable operation",
            Self::FaultReset => "Fault reset",
        }
    }

    /// Mask and value of the bits by which a word gives the command (IEC 61800-7-201, 6040h).
    const fn coding(self) -> (u16, u16) {
        match self {
            Self::Shutdown => (0x87, 0x06),
            Self::SwitchOn => (0x87, 0x07),
            Self::DisableVoltage => (0x82, 0x00),
            Self::QuickStop => (0x86, 0x02),
            Self::DisableOperation => (0x8F, 0x07),
            Self::EnableOperation => (0x8F, 0x0F),
            Self::FaultReset => (0x80, 0x80),
        }
    }
}

/// The controlword (6040h). Any sixteen bits may arrive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Stateful)]
pub struct Controlword(u16);

impl Controlword {
    /// The word that gives a command, with every bit cleared that the command leaves open.
    #[must_use]
    pub const fn of(command: Command) -> Self {
        Self(command.coding().1)
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

    /// True if the word has the bits of `command`; a fault reset also needs a previous word with bit 7 cleared.
    #[must_use]
    pub const fn gives(self, command: Command) -> bool {
        let (mask, value) = command.coding();
        self.0 & mask == value
    }

    /// True if `bit` is set.
    #[must_use]
    pub const fn has(self, bit: ControlBit) -> bool {
        self.0 & bit.mask() != 0
    }

    /// The word with `bit` set or cleared.
    #[must_use]
    pub const fn with(self, bit: ControlBit, set: bool) -> Self {
        if set { Self(self.0 | bit.mask()) } else { Self(self.0 & !bit.mask()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_of_a_start_up_give_their_commands() {
        // 0006h, 0007h, 000Fh: the sequence that every manual prints.
        let given = |bits| Command::ALL.into_iter().filter(move |command| Controlword::from_bits(bits).gives(*command));
        assert!(given(0x0006).eq([Command::Shutdown]));
        assert!(given(0x0007).eq([Command::SwitchOn, Command::DisableOperation]));
        assert!(given(0x000F).eq([Command::SwitchOn, Command::EnableOperation]));
        assert!(given(0x0080).eq([Command::FaultReset]));
        assert!(given(0x0000).eq([Command::DisableVoltage]));
        assert!(given(0x0002).eq([Command::QuickStop]));
    }

    #[test]
    fn every_word_gives_one_command_but_for_switch_on_which_two_others_share() {
        for bits in 0..=u16::MAX {
            let word = Controlword::from_bits(bits);
            assert_eq!(word.bits(), bits);
            let exclusive = Command::ALL.into_iter().filter(|c| *c != Command::SwitchOn && word.gives(*c)).count();
            assert_eq!(exclusive, 1, "{bits:04X}h");
            let share = word.gives(Command::DisableOperation) || word.gives(Command::EnableOperation);
            assert_eq!(word.gives(Command::SwitchOn), share, "{bits:04X}h");
        }
    }

    #[test]
    fn every_word_is_made_again_from_its_bits() {
        for bits in 0..=u16::MAX {
            let word = Controlword::from_bits(bits);
            let again = BITS.into_iter().fold(Controlword::default(), |made, bit| made.with(bit, word.has(bit)));
            assert_eq!(again, word);
        }
        assert_eq!(Controlword::from_bits(0x010F).with(ControlBit::Halt, false).bits(), 0x000F);
        for command in Command::ALL {
            assert!(Controlword::of(command).gives(command), "{command:?}");
        }
    }

    const BITS: [ControlBit; 16] = [
        ControlBit::SwitchOn,
        ControlBit::EnableVoltage,
        ControlBit::QuickStop,
        ControlBit::EnableOperation,
        ControlBit::ModeSpecific4,
        ControlBit::ModeSpecific5,
        ControlBit::ModeSpecific6,
        ControlBit::FaultReset,
        ControlBit::Halt,
        ControlBit::ModeSpecific9,
        ControlBit::Reserved10,
        ControlBit::ManufacturerSpecific11,
        ControlBit::ManufacturerSpecific12,
        ControlBit::ManufacturerSpecific13,
        ControlBit::ManufacturerSpecific14,
        ControlBit::ManufacturerSpecific15,
    ];
}
