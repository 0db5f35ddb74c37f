use super::{Damaged, Part, Stateful, Writer, restore, words};
use std::string::String;
use std::vec::Vec;

#[derive(Debug, Clone, PartialEq, Stateful)]
enum Way {
    Rest,
    To(f64, Option<u8>),
    Held { since: i64 },
}

#[derive(Debug, Clone, PartialEq, Stateful)]
struct Filter {
    #[state(constant)]
    corner: f64,
    memory: [f64; 2],
    #[state(derived)]
    output: f64,
    way: Way,
    #[state(fixed)]
    inner: Option<Inner>,
}

/// Without a default.
#[derive(Debug, Clone, PartialEq, Stateful)]
struct Inner(f64, bool);

fn saved(state: &impl Stateful) -> Vec<u64> {
    let mut all = Vec::new();
    state.save(&mut words(|word| all.push(word)));
    all
}

const FILTER: Filter = Filter {
    corner: 100.0,
    memory: [0.1, -0.0],
    output: f64::NAN,
    way: Way::To(2.5, Some(3)),
    inner: Some(Inner(f64::INFINITY, true)),
};

#[test]
fn a_restored_state_has_every_bit_and_its_own_parameters() {
    let mut other = Filter {
        corner: 7.0,
        memory: [9.0; 2],
        output: 0.0,
        way: Way::Held { since: -4 },
        inner: Some(Inner(0.0, false)),
    };
    let words = saved(&FILTER);
    restore(&mut other, &words).unwrap();
    assert_eq!(other.corner.to_bits(), 7.0_f64.to_bits());
    assert_eq!(saved(&other), words);
    for value in [i128::MIN, -1, 1 << 64, i128::MAX] {
        let mut other = 0_i128;
        restore(&mut other, &saved(&value)).unwrap();
        assert_eq!(other, value);
    }
    let held = Way::Held { since: -4 };
    let mut way = Way::Rest;
    restore(&mut way, &saved(&held)).unwrap();
    assert_eq!(way, held);
}

#[test]
fn another_form_is_refused() {
    let words = saved(&FILTER);
    let mut filter = FILTER;
    assert_eq!(restore(&mut filter, &words[1..]), Err(Damaged), "an end too early");
    let longer: Vec<u64> = words.iter().copied().chain([0]).collect();
    assert_eq!(restore(&mut filter, &longer), Err(Damaged), "an end too late");
    assert_eq!(restore(&mut Filter { inner: None, ..FILTER }, &words), Err(Damaged), "an option that is fixed");
    assert_eq!(restore(&mut Way::Rest, &[3]), Err(Damaged), "a variant that does not exist");
    assert_eq!(restore(&mut false, &[2]), Err(Damaged));
    assert_eq!(restore(&mut 0_u8, &[256]), Err(Damaged));
}

/// Names of numbers; derived ones are in brackets.
#[derive(Default)]
struct Names {
    path: Vec<Part>,
    all: Vec<String>,
}

impl Writer for Names {
    fn number(&mut self, _: f64) {
        let name = |part: &Part| if part.is_derived { ["(", part.name, ")"].concat() } else { part.name.into() };
        self.all.push(self.path.iter().map(name).collect::<Vec<_>>().join("."));
    }

    fn word(&mut self, _: u64) {}

    fn enter(&mut self, part: Part) {
        self.path.push(part);
    }

    fn leave(&mut self) {
        self.path.pop();
    }
}

#[test]
fn numbers_have_the_names_of_their_fields() {
    let mut names = Names::default();
    FILTER.save(&mut names);
    assert_eq!(names.all, ["memory", "memory", "(output)", "way.0", "inner.0"]);
}

#[cfg(feature = "std")]
#[test]
fn lists_grow_and_shrink_and_hostile_lengths_are_refused() {
    use std::string::ToString;
    let list = std::vec![Way::To(1.0, None), Way::Rest];
    let mut other = std::vec![Way::Rest; 5];
    restore(&mut other, &saved(&list)).unwrap();
    assert_eq!(other, list);
    assert_eq!(restore(&mut other, &[u64::MAX, 0]), Err(Damaged));
    let mut text = String::new();
    restore(&mut text, &saved(&"späte".to_string())).unwrap();
    assert_eq!(text, "späte");
}

#[cfg(feature = "std")]
#[test]
fn texts_of_errors_are_kept_once_and_not_without_end() {
    let mut one: &'static str = "velocity";
    let words = saved(&one);
    restore(&mut one, &words).unwrap();
    let first = one.as_ptr();
    restore(&mut one, &words).unwrap();
    assert!(one == "velocity" && one.as_ptr() == first);
    let long: &'static str = Box::leak("x".repeat(1 << 17).into());
    assert_eq!(restore(&mut one, &saved(&long)), Err(Damaged));
}
