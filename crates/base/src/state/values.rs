//! States that are values: numbers, flags, and compositions of states.
use super::{Damaged, FixedForm, Part, Reader, Stateful, Value, Writer};
use core::convert::identity;

/// Implements [`Stateful`] and [`Value`] for a type by a function that writes it and one that reads it.
macro_rules! values {
    ($($type:ty: $save:expr, $restored:expr;)*) => {$(
        impl Stateful for $type {
            fn save(&self, to: &mut dyn Writer) {
                $save(to, *self);
            }

            fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
                *self = Self::restored(from)?;
                Ok(())
            }
        }

        impl Value for $type {
            fn restored(from: &mut Reader<'_>) -> Result<Self, Damaged> {
                $restored(from)
            }
        }
    )*};
}

macro_rules! integers {
    ($($type:ty: $to:expr, $from:expr;)*) => {
        values! {$(
            $type: |to: &mut dyn Writer, value| to.word($to(value)),
                |from: &mut Reader<'_>| $from(from.word()?).try_into().map_err(|_| Damaged);
        )*}
    };
}

const fn signed(value: i64) -> u64 {
    value.cast_unsigned()
}

/// Lower and upper half.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "halves")]
const fn halves(value: i128) -> [u64; 2] {
    [value as u64, (value >> 64) as u64]
}

fn whole([lower, upper]: [u64; 2]) -> i128 {
    (u128::from(upper) << 64 | u128::from(lower)).cast_signed()
}

integers! {
    u8: u64::from, identity;
    u16: u64::from, identity;
    u32: u64::from, identity;
    usize: |value: usize| value as u64, identity;
    i8: |value| signed(i64::from(value)), u64::cast_signed;
    i16: |value| signed(i64::from(value)), u64::cast_signed;
    i32: |value| signed(i64::from(value)), u64::cast_signed;
}

values! {
    f64: |to: &mut dyn Writer, value| to.number(value), Reader::number;
    u64: |to: &mut dyn Writer, value| to.word(value), Reader::word;
    i64: |to: &mut dyn Writer, value| to.word(signed(value)), |from: &mut Reader<'_>| from.word().map(u64::cast_signed);
    i128: |to: &mut dyn Writer, value: i128| for half in halves(value) { to.word(half) },
        |from: &mut Reader<'_>| Ok(whole([from.word()?, from.word()?]));
    bool: |to: &mut dyn Writer, value: bool| to.word(value.into()), |from: &mut Reader<'_>| match from.word()? {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(Damaged),
    };
    (): |_: &mut dyn Writer, ()| {}, |_: &mut Reader<'_>| Ok(());
}

macro_rules! tuples {
    ($($name:ident $index:tt),*) => {
        impl<$($name: Stateful),*> Stateful for ($($name,)*) {
            fn save(&self, to: &mut dyn Writer) {
                $(
                    to.enter(Part::field(stringify!($index)));
                    self.$index.save(to);
                    to.leave();
                )*
            }

            fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
                $(self.$index.restore(from)?;)*
                Ok(())
            }
        }

        impl<$($name: Value),*> Value for ($($name,)*) {
            fn restored(from: &mut Reader<'_>) -> Result<Self, Damaged> {
                Ok(($($name::restored(from)?,)*))
            }
        }
    };
}

tuples!(A 0, B 1);
tuples!(A 0, B 1, C 2);
tuples!(A 0, B 1, C 2, D 3);

impl<T: Stateful, const N: usize> Stateful for [T; N] {
    fn save(&self, to: &mut dyn Writer) {
        for one in self {
            one.save(to);
        }
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        self.iter_mut().try_for_each(|one| one.restore(from))
    }
}

impl<T: Value, const N: usize> Value for [T; N] {
    fn restored(from: &mut Reader<'_>) -> Result<Self, Damaged> {
        let mut error = Ok(());
        let all = core::array::from_fn(|_| T::restored(from).map_err(|damaged| error = Err(damaged)).ok());
        error?;
        // None is missing: each of them would have been an error.
        Ok(all.map(|one: Option<T>| one.unwrap_or_else(|| unreachable!("restored"))))
    }
}

impl<T: Value> Stateful for Option<T> {
    fn save(&self, to: &mut dyn Writer) {
        self.save_fixed(to);
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        *self = Self::restored(from)?;
        Ok(())
    }
}

impl<T: Value> Value for Option<T> {
    fn restored(from: &mut Reader<'_>) -> Result<Self, Damaged> {
        if bool::restored(from)? { T::restored(from).map(Some) } else { Ok(None) }
    }
}

impl<T: Stateful> FixedForm for Option<T> {
    fn save_fixed(&self, to: &mut dyn Writer) {
        to.word(self.is_some().into());
        if let Some(one) = self {
            one.save(to);
        }
    }

    fn restore_fixed(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        if from.word()? != u64::from(self.is_some()) {
            return Err(Damaged);
        }
        self.as_mut().map_or(Ok(()), |one| one.restore(from))
    }
}

impl<T: Stateful> FixedForm for [T] {
    fn save_fixed(&self, to: &mut dyn Writer) {
        to.word(self.len() as u64);
        for one in self {
            one.save(to);
        }
    }

    fn restore_fixed(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        if from.word()? != self.len() as u64 {
            return Err(Damaged);
        }
        self.iter_mut().try_for_each(|one| one.restore(from))
    }
}

/// A name or a bound in an error. Without the feature `std`, a state that contains one cannot be restored.
impl Stateful for &'static str {
    fn save(&self, to: &mut dyn Writer) {
        to.word(self.len() as u64);
        for byte in self.bytes() {
            to.word(byte.into());
        }
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        *self = Self::restored(from)?;
        Ok(())
    }
}

impl Value for &'static str {
    #[cfg(feature = "std")]
    fn restored(from: &mut Reader<'_>) -> Result<Self, Damaged> {
        super::texts::kept(&std::string::String::restored(from)?)
    }

    #[cfg(not(feature = "std"))]
    fn restored(_: &mut Reader<'_>) -> Result<Self, Damaged> {
        Err(Damaged)
    }
}

#[cfg(feature = "std")]
mod with_a_heap {
    use super::{Damaged, FixedForm, Reader, Stateful, Value, Writer};
    use std::boxed::Box;
    use std::collections::VecDeque;
    use std::string::String;
    use std::vec::Vec;

    impl<T: Stateful> Stateful for Box<T> {
        fn save(&self, to: &mut dyn Writer) {
            (**self).save(to);
        }

        fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
            (**self).restore(from)
        }
    }

    impl<T: Value> Value for Box<T> {
        fn restored(from: &mut Reader<'_>) -> Result<Self, Damaged> {
            T::restored(from).map(Self::new)
        }
    }

    macro_rules! lists {
        ($($list:ident),*) => {$(
            impl<T: Value> Stateful for $list<T> {
                fn save(&self, to: &mut dyn Writer) {
                    to.word(self.len() as u64);
                    for one in self {
                        one.save(to);
                    }
                }

                fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
                    let length = from.length()?;
                    self.clear();
                    self.reserve(length);
                    for _ in 0..length {
                        self.extend([T::restored(from)?]);
                    }
                    Ok(())
                }
            }

            impl<T: Value> Value for $list<T> {
                fn restored(from: &mut Reader<'_>) -> Result<Self, Damaged> {
                    let mut list = Self::new();
                    list.restore(from)?;
                    Ok(list)
                }
            }
        )*};
    }

    lists!(Vec, VecDeque);

    impl<T: Stateful> FixedForm for Vec<T> {
        fn save_fixed(&self, to: &mut dyn Writer) {
            self[..].save_fixed(to);
        }

        fn restore_fixed(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
            self[..].restore_fixed(from)
        }
    }

    impl Stateful for String {
        fn save(&self, to: &mut dyn Writer) {
            to.word(self.len() as u64);
            for byte in self.bytes() {
                to.word(byte.into());
            }
        }

        fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
            *self = Self::restored(from)?;
            Ok(())
        }
    }

    impl Value for String {
        fn restored(from: &mut Reader<'_>) -> Result<Self, Damaged> {
            Self::from_utf8(Vec::restored(from)?).map_err(|_| Damaged)
        }
    }
}
