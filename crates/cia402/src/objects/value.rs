//! Types and values of objects.
use core::fmt;

/// Declares the data types, their values and their storage in 64 bits.
macro_rules! data_types {
    ($($(#[$doc:meta])* $name:ident($type:ty) = $code:literal, $text:literal;)*) => {
        /// Data type of an object (CiA 301, section 7.4.7).
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[repr(u16)]
        pub enum DataType { $($(#[$doc])* $name = $code,)* }

        impl DataType {
            /// Every type of the objects here.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// Name in the words of the standard.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$name => $text,)* }
            }

            /// Length on the bus (byte).
            #[must_use]
            pub const fn size(self) -> usize {
                match self { $(Self::$name => size_of::<$type>(),)* }
            }

            /// Smallest value.
            #[must_use]
            pub const fn lowest(self) -> i128 {
                match self { $(Self::$name => <$type>::MIN as i128,)* }
            }

            /// Largest value.
            #[must_use]
            pub const fn highest(self) -> i128 {
                match self { $(Self::$name => <$type>::MAX as i128,)* }
            }

            /// Value of these bits; those above its size are ignored.
            #[expect(clippy::cast_possible_truncation, reason = "bits above the size of the type are not part of the value")]
            pub(super) const fn value(self, bits: u64) -> Value {
                match self { $(Self::$name => Value::$name(bits as $type),)* }
            }
        }

        /// A value of an object, with its type.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Value { $($(#[$doc])* $name($type),)* }

        impl Value {
            /// Data type.
            #[must_use]
            pub const fn data_type(self) -> DataType {
                match self { $(Self::$name(_) => DataType::$name,)* }
            }

            /// Bits of the value; a negative number is sign-extended above its size.
            #[expect(clippy::cast_sign_loss, reason = "the bits are kept")]
            pub(super) const fn bits(self) -> u64 {
                match self { $(Self::$name(value) => value as u64,)* }
            }

            /// Numeric value.
            #[must_use]
            pub const fn number(self) -> i128 {
                match self { $(Self::$name(value) => value as i128,)* }
            }
        }

        impl fmt::Display for Value {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self { $(Self::$name(value) => value.fmt(f),)* }
            }
        }

        #[expect(clippy::cast_possible_truncation, reason = "bits above the size of the type are not part of the value")]
        const _: () = {
            $(
                impl Stored for $type {
                    const DATA_TYPE: DataType = DataType::$name;

                    fn of_bits(bits: u64) -> Self {
                        bits as Self
                    }

                    fn value(self) -> Value {
                        Value::$name(self)
                    }
                }

                impl From<$type> for Value {
                    fn from(value: $type) -> Self {
                        Self::$name(value)
                    }
                }
            )*
        };
    };
}

/// A Rust type of an object's value.
pub trait Stored: Copy {
    /// Data type in the standard.
    const DATA_TYPE: DataType;

    /// Value of these bits.
    fn of_bits(bits: u64) -> Self;

    /// Value with its type.
    fn value(self) -> Value;
}

data_types! {
    /// −128 to 127.
    Integer8(i8) = 0x0002, "INTEGER8";
    /// −32 768 to 32 767.
    Integer16(i16) = 0x0003, "INTEGER16";
    /// −2³¹ to 2³¹ − 1.
    Integer32(i32) = 0x0004, "INTEGER32";
    /// 0 to 255.
    Unsigned8(u8) = 0x0005, "UNSIGNED8";
    /// 0 to 65 535.
    Unsigned16(u16) = 0x0006, "UNSIGNED16";
    /// 0 to 2³² − 1.
    Unsigned32(u32) = 0x0007, "UNSIGNED32";
    /// 0 to 2⁶⁴ − 1.
    Unsigned64(u64) = 0x001B, "UNSIGNED64";
}

impl DataType {
    /// Index of the type in the object dictionary (CiA 301, table 44).
    #[must_use]
    pub const fn code(self) -> u16 {
        self as u16
    }
}

/// Longest value (byte).
const LONGEST: usize = 8;

impl Value {
    /// Value of these bytes, the lowest first; `None` unless their number is the size of the type.
    #[must_use]
    pub fn of_bytes(data_type: DataType, bytes: &[u8]) -> Option<Self> {
        if bytes.len() != data_type.size() {
            return None;
        }
        let mut all = [0; LONGEST];
        all.get_mut(..bytes.len())?.copy_from_slice(bytes);
        Some(data_type.value(u64::from_le_bytes(all)))
    }

    /// Bytes as sent over the bus, the lowest first; only the first [`DataType::size`] of them are valid.
    #[must_use]
    pub const fn bytes(self) -> [u8; LONGEST] {
        self.bits().to_le_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_on_the_bus_are_those_of_rust() {
        assert_eq!(Value::Integer16(-2).bytes()[..2], (-2_i16).to_le_bytes());
        assert_eq!(Value::of_bytes(DataType::Integer16, &[0xFE, 0xFF]), Some(Value::Integer16(-2)));
        assert_eq!(Value::of_bytes(DataType::Unsigned32, &0xFFFF_FFFE_u32.to_le_bytes()), Some((u32::MAX - 1).into()));
        assert_eq!(Value::of_bytes(DataType::Unsigned64, &u64::MAX.to_le_bytes()), Some(u64::MAX.into()));
        assert_eq!(Value::of_bytes(DataType::Integer32, &[1, 2, 3]), None);
    }

    #[test]
    fn every_type_reads_back_its_bounds() {
        for data_type in DataType::ALL.iter().copied() {
            for bound in [data_type.lowest(), data_type.highest()] {
                let bytes = bound.to_le_bytes();
                let value = Value::of_bytes(data_type, &bytes[..data_type.size()]).unwrap();
                assert_eq!((value.number(), value.data_type()), (bound, data_type));
                assert_eq!(value.bytes()[..data_type.size()], bytes[..data_type.size()]);
            }
        }
    }
}
