//! Batches of variables: the wired variables of one type, set or read in one call, with memory allocated once.
use super::instance::Slot;
use crate::description::{DataType, ModelDescription, Variability, Version};
use crate::library::status::Outcome;
use crate::library::{Access, Called};
use crate::library::{three, two};
use crate::setup::Wire;

/// A type of exchanged values.
pub(super) trait Element: Copy + PartialEq + Send + 'static {
    /// Values it accepts, in words.
    const BOUND: &'static str;
    /// Initial value.
    const ZERO: Self;
    fn of(number: f64) -> Option<Self>;
    fn number(self) -> f64;
}

impl Element for f64 {
    const BOUND: &'static str = "finite numbers";
    const ZERO: Self = 0.0;
    fn of(number: f64) -> Option<Self> {
        number.is_finite().then_some(number)
    }
    fn number(self) -> f64 {
        self
    }
}

impl Element for f32 {
    const BOUND: &'static str = "finite numbers of single precision";
    const ZERO: Self = 0.0;
    fn of(number: f64) -> Option<Self> {
        #[expect(clippy::cast_possible_truncation, reason = "rounded to what the variable holds")]
        let single = number as f32;
        single.is_finite().then_some(single)
    }
    fn number(self) -> f64 {
        self.into()
    }
}

macro_rules! integers {
    ($($type:ty, $bound:literal, $number:expr;)*) => {$(
        impl Element for $type {
            const BOUND: &'static str = $bound;
            const ZERO: Self = 0;
            fn of(number: f64) -> Option<Self> {
                #[expect(clippy::cast_possible_truncation, reason = "as far as i128 goes, beyond which nothing fits")]
                let whole = number as i128;
                (number.fract() == 0.0).then(|| whole.try_into().ok())?
            }
            fn number(self) -> f64 {
                $number(self)
            }
        }
    )*};
}

integers! {
    i8, "whole numbers of 8 bits", f64::from;
    u8, "whole numbers of 8 bits, none negative", f64::from;
    i16, "whole numbers of 16 bits", f64::from;
    u16, "whole numbers of 16 bits, none negative", f64::from;
    i32, "whole numbers of 32 bits", f64::from;
    u32, "whole numbers of 32 bits, none negative", f64::from;
    // Rounded.
    i64, "whole numbers of 64 bits", |number| number as f64;
    u64, "whole numbers of 64 bits, none negative", |number| number as f64;
}

macro_rules! flags {
    ($($type:path),*) => {$(
        impl Element for $type {
            const BOUND: &'static str = "0 and 1";
            const ZERO: Self = Self(0);
            fn of(number: f64) -> Option<Self> {
                <u8 as Element>::of(number).filter(|number| *number < 2).map(|number| Self(number.into()))
            }
            fn number(self) -> f64 {
                if self.0 == 0 { 0.0 } else { 1.0 }
            }
        }
    )*};
}

flags!(two::Flag, three::Flag);

/// Position of a port in the values of a batch.
#[derive(Debug, Clone, Copy)]
struct Place {
    port: usize,
    at: usize,
}

/// Variables of one type, with the positions of their ports.
#[derive(Debug, Default)]
pub(super) struct Layout {
    references: Vec<u32>,
    /// Position of each variable in the description.
    variables: Vec<usize>,
    starts: Vec<usize>,
    len: usize,
    places: Vec<Place>,
}

impl Layout {
    fn add(&mut self, port: usize, wire: Wire, reference: u32, count: usize) {
        let known = self.variables.iter().position(|variable| *variable == wire.variable);
        let start = known.map_or(self.len, |known| self.starts[known]);
        if known.is_none() {
            self.references.push(reference);
            self.variables.push(wire.variable);
            self.starts.push(start);
            self.len += count;
        }
        self.places.push(Place { port, at: start + wire.element });
    }
}

/// A value that its variable cannot take.
#[derive(Debug, Clone, Copy)]
pub(super) struct Misfit {
    pub(super) port: usize,
    pub(super) value: f64,
    pub(super) bound: &'static str,
}

/// A batch of variables of one type of an instance `I`.
pub(super) trait Batch<I>: Send {
    /// Takes the values of its ports; returns true if one has changed.
    fn take(&mut self, number: &dyn Fn(usize) -> f64) -> Result<bool, Misfit>;
    /// Sets the values taken.
    fn set(&self, instance: &I) -> Called;
    /// Reads all of its variables.
    fn get(&mut self, instance: &I) -> Called;
    /// Writes the values of its ports to `numbers`.
    fn give(&self, numbers: &mut [f64]);
    /// True if it has elements without a port.
    fn has_others(&self) -> bool;
    /// Saves its values along with a state of the instance.
    fn keep(&mut self, slot: Slot);
    /// Restores the saved values.
    fn recall(&mut self, slot: Slot);
}

struct Typed<T> {
    layout: Layout,
    values: Vec<T>,
    /// True until values are taken for the first time.
    is_fresh: bool,
    kept: [(Vec<T>, bool); Slot::COUNT],
}

impl<T: Element, I: Access<T>> Batch<I> for Typed<T> {
    fn take(&mut self, number: &dyn Fn(usize) -> f64) -> Result<bool, Misfit> {
        let mut is_new = std::mem::take(&mut self.is_fresh);
        for place in &self.layout.places {
            let value = number(place.port);
            let misfit = Misfit { port: place.port, value, bound: T::BOUND };
            let taken = T::of(value).ok_or(misfit)?;
            is_new |= self.values[place.at] != taken;
            self.values[place.at] = taken;
        }
        Ok(is_new)
    }

    fn set(&self, instance: &I) -> Called {
        instance.set(&self.layout.references, &self.values)
    }

    fn get(&mut self, instance: &I) -> Called {
        instance.get(&self.layout.references, &mut self.values)
    }

    fn give(&self, numbers: &mut [f64]) {
        for place in &self.layout.places {
            numbers[place.port] = self.values[place.at].number();
        }
    }

    fn has_others(&self) -> bool {
        self.layout.places.len() < self.values.len()
    }

    fn keep(&mut self, slot: Slot) {
        let (values, is_fresh) = &mut self.kept[slot as usize];
        values.clone_from(&self.values);
        *is_fresh = self.is_fresh;
    }

    fn recall(&mut self, slot: Slot) {
        let (values, is_fresh) = &self.kept[slot as usize];
        self.values.clone_from(values);
        self.is_fresh = *is_fresh;
    }
}

/// Boxed batches of an instance.
pub(super) type Batches<I> = Vec<Box<dyn Batch<I>>>;

fn boxed<T: Element, I: Access<T>>(layout: Layout) -> Box<dyn Batch<I>> {
    let values = vec![T::ZERO; layout.len];
    let kept = [(values.clone(), true), (values.clone(), true)];
    Box::new(Typed::<T> { layout, values, is_fresh: true, kept })
}

/// An instance whose variables have batches.
pub(super) trait Batched: Sized {
    /// The batch of a type; none for a type that is not exchanged as a number.
    fn batch(data_type: DataType, layout: Layout) -> Option<Box<dyn Batch<Self>>>;
}

impl Batched for two::Two {
    fn batch(data_type: DataType, layout: Layout) -> Option<Box<dyn Batch<Self>>> {
        match data_type {
            DataType::Float64 => Some(boxed::<f64, Self>(layout)),
            DataType::Int32 | DataType::Enumeration => Some(boxed::<i32, Self>(layout)),
            DataType::Boolean => Some(boxed::<two::Flag, Self>(layout)),
            _ => None,
        }
    }
}

impl Batched for three::Three {
    fn batch(data_type: DataType, layout: Layout) -> Option<Box<dyn Batch<Self>>> {
        Some(match data_type {
            DataType::Float32 => boxed::<f32, Self>(layout),
            DataType::Float64 => boxed::<f64, Self>(layout),
            DataType::Int8 => boxed::<i8, Self>(layout),
            DataType::UInt8 => boxed::<u8, Self>(layout),
            DataType::Int16 => boxed::<i16, Self>(layout),
            DataType::UInt16 => boxed::<u16, Self>(layout),
            DataType::Int32 => boxed::<i32, Self>(layout),
            DataType::UInt32 => boxed::<u32, Self>(layout),
            DataType::Int64 | DataType::Enumeration => boxed::<i64, Self>(layout),
            DataType::UInt64 => boxed::<u64, Self>(layout),
            DataType::Boolean => boxed::<three::Flag, Self>(layout),
            DataType::String | DataType::Binary | DataType::Clock => return None,
        })
    }
}

/// Type in which variables are grouped: FMI 2.0 has its enumerations among the integers, FMI 3.0 among those of 64 bits.
fn group(data_type: DataType, version: Version) -> DataType {
    match (data_type, version) {
        (DataType::Enumeration, Version::Two) => DataType::Int32,
        (DataType::Enumeration, Version::Three) => DataType::Int64,
        _ => data_type,
    }
}

/// The batches of all wires whose variability passes `is_in`.
pub(super) fn batches<I: Batched>(
    it: &ModelDescription,
    wires: &[Wire],
    counts: &[usize],
    is_in: impl Fn(Variability) -> bool,
) -> Batches<I> {
    batches_of(it, wires.iter().enumerate(), counts, is_in)
}

/// The same for some of the wires, each with the number of its port.
pub(super) fn batches_of<'a, I: Batched>(
    it: &ModelDescription,
    wires: impl Iterator<Item = (usize, &'a Wire)>,
    counts: &[usize],
    is_in: impl Fn(Variability) -> bool,
) -> Batches<I> {
    let mut layouts: Vec<(DataType, Layout)> = vec![];
    for (port, wire) in wires {
        let variable = &it.variables[wire.variable];
        if !is_in(variable.variability) {
            continue;
        }
        let group = group(variable.data_type, it.version);
        let at = layouts.iter().position(|(known, _)| *known == group).unwrap_or_else(|| {
            layouts.push((group, Layout::default()));
            layouts.len() - 1
        });
        layouts[at].1.add(port, *wire, variable.value_reference, counts[wire.variable]);
    }
    layouts.into_iter().filter_map(|(data_type, layout)| I::batch(data_type, layout)).collect()
}

/// Reads all batches; stops at the first failure.
pub(super) fn read<I>(batches: &mut Batches<I>, instance: &I, numbers: &mut [f64]) -> Called {
    all(batches.iter_mut().map(|batch| {
        let called = batch.get(instance);
        batch.give(numbers);
        called
    }))
}

/// Makes calls up to the first that fails; returns the outcome of the last one.
pub(super) fn all(calls: impl Iterator<Item = Called>) -> Called {
    let mut last = ("", Outcome::Done);
    for called in calls {
        last = called;
        if called.1 != Outcome::Done {
            break;
        }
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_not_taken() {
        assert_eq!(i8::of(-128.0), Some(-128));
        assert_eq!((i8::of(128.0), i8::of(0.5), i8::of(f64::NAN)), (None, None, None));
        // 2^64 is one more than the greatest; the f64 before it fits.
        assert_eq!(
            (u64::of(18446744073709551616.0), u64::of(18446744073709549568.0)),
            (None, Some(18446744073709549568))
        );
        assert_eq!((u32::of(-0.0), u32::of(-1.0)), (Some(0), None));
        assert_eq!((f32::of(1e300), f32::of(0.1)), (None, Some(0.1)));
        assert_eq!((two::Flag::of(1.0), two::Flag::of(2.0)), (Some(two::Flag(1)), None));
        assert_eq!(f64::of(f64::INFINITY), None);
    }
}
