//! States that are values: numbers, flags, and what is made of several states.
use super::{Damaged, FixedForm, Part, Reader, Stateful, Writer};
use core::convert::identity;

impl Stateful for f64 {
    fn save(&self, to: &mut dyn Writer) {
        to.number(*self);
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        *self = from.number()?;
        Ok(())
    }
}

impl Stateful for bool {
    fn save(&self, to: &mut dyn Writer) {
        to.word((*self).into());
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        *self = match from.word()? {
            0 => false,
            1 => true,
            _ => return Err(Damaged),
        };
        Ok(())
    }
}

macro_rules! integers {
    ($($type:ty, $to:expr, $from:expr;)*) => {$(
        impl Stateful for $type {
            fn save(&self, to: &mut dyn Writer) {
                to.word($to(*self));
            }

            fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
                *self = $from(from.word()?).try_into().map_err(|_| Damaged)?;
                Ok(())
            }
        }
    )*};
}

const fn signed(value: i64) -> u64 {
    value.cast_unsigned()
}

integers! {
    u8, u64::from, identity;
    u16, u64::from, identity;
    u32, u64::from, identity;
    usize, |value: usize| value as u64, identity;
    i8, |value| signed(i64::from(value)), u64::cast_signed;
    i16, |value| signed(i64::from(value)), u64::cast_signed;
    i32, |value| signed(i64::from(value)), u64::cast_signed;
}

impl Stateful for u64 {
    fn save(&self, to: &mut dyn Writer) {
        to.word(*self);
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        *self = from.word()?;
        Ok(())
    }
}

impl Stateful for i64 {
    fn save(&self, to: &mut dyn Writer) {
        to.word(signed(*self));
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        *self = from.word()?.cast_signed();
        Ok(())
    }
}

impl Stateful for () {
    fn save(&self, _: &mut dyn Writer) {}

    fn restore(&mut self, _: &mut Reader<'_>) -> Result<(), Damaged> {
        Ok(())
    }
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

impl<T: Stateful + Default> Stateful for Option<T> {
    fn save(&self, to: &mut dyn Writer) {
        self.save_fixed(to);
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        let mut is_some = false;
        is_some.restore(from)?;
        if is_some {
            return self.get_or_insert_default().restore(from);
        }
        *self = None;
        Ok(())
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

#[cfg(feature = "alloc")]
mod with_a_heap {
    use super::{Damaged, FixedForm, Reader, Stateful, Writer};
    use alloc::boxed::Box;
    use alloc::collections::VecDeque;
    use alloc::string::String;
    use alloc::vec::Vec;

    impl<T: Stateful + ?Sized> Stateful for Box<T> {
        fn save(&self, to: &mut dyn Writer) {
            (**self).save(to);
        }

        fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
            (**self).restore(from)
        }
    }

    impl<T: Stateful + Default> Stateful for Vec<T> {
        fn save(&self, to: &mut dyn Writer) {
            self[..].save_fixed(to);
        }

        fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
            let length = from.length()?;
            self.resize_with(length, T::default);
            self.iter_mut().try_for_each(|one| one.restore(from))
        }
    }

    impl<T: Stateful> FixedForm for Vec<T> {
        fn save_fixed(&self, to: &mut dyn Writer) {
            self[..].save_fixed(to);
        }

        fn restore_fixed(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
            self[..].restore_fixed(from)
        }
    }

    impl<T: Stateful + Default> Stateful for VecDeque<T> {
        fn save(&self, to: &mut dyn Writer) {
            to.word(self.len() as u64);
            for one in self {
                one.save(to);
            }
        }

        fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
            let length = from.length()?;
            self.resize_with(length, T::default);
            self.iter_mut().try_for_each(|one| one.restore(from))
        }
    }

    impl Stateful for String {
        fn save(&self, to: &mut dyn Writer) {
            to.word(self.len() as u64);
            self.bytes().for_each(|byte| to.word(byte.into()));
        }

        fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
            let mut bytes = Vec::new();
            bytes.resize_with(from.length()?, || 0_u8);
            bytes.iter_mut().try_for_each(|byte| byte.restore(from))?;
            *self = Self::from_utf8(bytes).map_err(|_| Damaged)?;
            Ok(())
        }
    }
}
