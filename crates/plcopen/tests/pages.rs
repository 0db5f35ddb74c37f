//! `docs/plcopen.md` holds the tables of the arrows, the ErrorIDs and the outputs.
//! `SERVOBENCH_WRITE_DOCS=1 cargo test -p servobench-plcopen` writes them.
use servobench_motion::pvt::Knot;
use servobench_plcopen::{
    ARROWS, AccelerationProfile, ErrorId, FunctionBlock, Halt, Home, MoveAbsolute, MoveAdditive,
    MoveContinuousAbsolute, MoveRelative, MoveSuperimposed, MoveVelocity, Outputs, Pair, PositionProfile, Power,
    Profile4th, ReadActualPosition, ReadActualTorque, ReadActualVelocity, ReadAxisError, ReadStatus, Reset,
    SetOverride, SetPosition, Stop, TorqueControl, VelocityProfile,
};
use std::fmt::Write as _;
use std::path::Path;

const WRITE_DOCS: &str = "SERVOBENCH_WRITE_DOCS";

#[test]
fn the_page_lists_every_arrow_every_error_and_every_output() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/plcopen.md");
    let written = std::fs::read_to_string(&path).unwrap();
    let parts = [("arrows", arrows()), ("errors", errors()), ("outputs", outputs())];
    let page = parts.iter().fold(written.clone(), |page, (name, table)| replaced(&page, name, table));
    if std::env::var_os(WRITE_DOCS).is_some() {
        std::fs::write(&path, page).unwrap();
    } else {
        assert!(written == page, "run the tests of this crate with {WRITE_DOCS}=1");
    }
}

/// `page` with `table` between the marks of `name`.
fn replaced(page: &str, name: &str, table: &str) -> String {
    let (begin, end) = (format!("<!-- generated: {name} -->\n"), format!("<!-- end of generated {name} -->\n"));
    let (before, rest) = page.split_once(&begin).unwrap();
    let (_, after) = rest.split_once(&end).unwrap();
    format!("{before}{begin}{table}{end}{after}")
}

fn arrows() -> String {
    let mut table = String::from("| no. | from | to | cause |\n|---|---|---|---|\n");
    for arrow in &ARROWS {
        let from: Vec<&str> = arrow.from.iter().map(|state| state.name()).collect();
        let causes: Vec<&str> = arrow.causes.iter().map(|cause| cause.name()).collect();
        let (number, to) = (arrow.number, arrow.to);
        writeln!(table, "| {number} | {} | {to} | {} |", from.join(", "), causes.join(", ")).unwrap();
    }
    table
}

fn errors() -> String {
    let mut table = String::from("| ErrorID | meaning |\n|---|---|\n");
    for id in ErrorId::ALL {
        writeln!(table, "| 16#{:04X} | {} |", id.number(), id.meaning()).unwrap();
    }
    table
}

fn outputs() -> String {
    let mut table = String::from("| block | outputs |\n|---|---|\n");
    let mut row = |(name, outputs): (&str, &[&str])| writeln!(table, "| {name} | {} |", outputs.join(", ")).unwrap();
    row(of::<Power>());
    row(of::<Home>());
    row(of::<Stop>());
    row(of::<Halt>());
    row(of::<Reset>());
    row(of::<MoveAbsolute>());
    row(of::<MoveRelative>());
    row(of::<MoveAdditive>());
    row(of::<MoveSuperimposed>());
    row(of::<MoveVelocity>());
    row(of::<MoveContinuousAbsolute>());
    row(of::<TorqueControl>());
    row(of::<PositionProfile<[Knot; 0], [f64; 0]>>());
    row(of::<VelocityProfile<[Pair; 0]>>());
    row(of::<AccelerationProfile<[Pair; 0]>>());
    row(of::<Profile4th>());
    row(of::<SetPosition>());
    row(of::<SetOverride>());
    row(of::<ReadStatus>());
    row(of::<ReadAxisError>());
    row(of::<ReadActualPosition>());
    row(of::<ReadActualVelocity>());
    row(of::<ReadActualTorque>());
    table
}

fn of<B: FunctionBlock>() -> (&'static str, &'static [&'static str]) {
    (B::NAME.name(), B::Outputs::NAMES)
}

#[test]
fn no_two_errors_share_a_number() {
    for (place, id) in ErrorId::ALL.iter().enumerate() {
        assert!(ErrorId::ALL[..place].iter().all(|other| other.number() != id.number()), "{id:?}");
    }
}
