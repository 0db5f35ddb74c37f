//! The rules of the standard for the outputs of a block (PLCopen part 1, version 2.0, section 2.4.1).
use servobench_plcopen::{Axis, BlockName, ErrorId, FunctionBlock, Output, Outputs};

/// Outputs that blocks have in common, FALSE where a block has no such output.
#[derive(Debug, Clone, Copy, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is an output of the standard")]
pub(crate) struct Flags {
    pub(crate) done: bool,
    pub(crate) busy: bool,
    pub(crate) active: bool,
    pub(crate) in_target: bool,
    pub(crate) aborted: bool,
    pub(crate) error: bool,
    pub(crate) error_id: u64,
}

/// One call of `block`.
pub(crate) fn call<B: FunctionBlock>(block: &mut B, axis: &mut Axis, inputs: &B::Inputs<'_>) -> Flags {
    let outputs = block.step(axis, inputs);
    let (mut flags, mut names) = (Flags::default(), B::Outputs::LIST.iter());
    outputs.each(|value| {
        let is_true = value > 0.5;
        match *names.next().expect("as many names as values") {
            Output::Done | Output::ProfileCompleted => flags.done = is_true,
            Output::Busy => flags.busy = is_true,
            Output::Active => flags.active = is_true,
            Output::InVelocity | Output::InTorque | Output::InEndVelocity => flags.in_target = is_true,
            Output::CommandAborted => flags.aborted = is_true,
            Output::Error => flags.error = is_true,
            Output::ErrorId => flags.error_id = value.to_bits(),
            Output::CoveredDistance | Output::Ready | Output::RecordedPosition => assert!(value.is_finite()),
            Output::Position
            | Output::Velocity
            | Output::Acceleration
            | Output::Jerk
            | Output::Snap
            | Output::Added => {
                assert!(value.is_finite());
            }
            other => unreachable!("{other:?}"),
        }
    });
    assert_eq!(block.error().is_some(), flags.error, "{} in words", B::NAME);
    // The generator has no other output for invalid limits.
    if let Some(error) = block.error().filter(|_| B::NAME != BlockName::Profile4th) {
        assert!(!matches!(error.id(), ErrorId::Plan | ErrorId::PlanLost), "{error}");
    }
    flags
}

impl Flags {
    /// Checks the rules that hold in every cycle; `before` has the flags of the previous call.
    pub(crate) fn check(&self, place: &str, execute: bool, before: &Self) {
        let Self { done, busy, active, in_target, aborted, error, error_id } = *self;
        let one = [done, busy, aborted, error].into_iter().filter(|flag| *flag).count();
        assert!(one <= 1, "{place}: {self:?}");
        assert!(one == 1 || !execute, "{place}: executed, and says nothing: {self:?}");
        assert!(busy || !active && !in_target, "{place}: {self:?}");
        assert_eq!(error, error_id != f64::from(ErrorId::None as u16).to_bits(), "{place}: {self:?}");
        // The result stays as long as Execute is TRUE, and for one call at least.
        assert!(execute || busy || one == 0 || before.busy, "{place}: goes on to say how it ended: {self:?}");
    }
}
