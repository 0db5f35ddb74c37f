//! Tables of points: time, position and optionally velocity, as comma-separated values.
//!
//! ```text
//! time [ms],position [mm],velocity [mm/s]
//! 0,0,0
//! 10,5,
//! 20,15,1000
//! ```
//! The heading names the columns, in any order, with the unit of all their numbers. `velocity` may be left out, or left empty in a
//! row. Times increase. Spaces around numbers and empty lines are ignored; the decimal sign is a point. Columns
//! `acceleration`, `jerk` and `snap`, which a planned move has, are read but not used: the path from point to point is the
//! cubic between positions and velocities, or a line.
//!
//! A column `step` in place of `position` holds the distance from the previous point, and for the first point from the initial
//! position of the axis: the points of a drive with their relative flag.
//!
//! A profile is such a table of which the times and the velocities, or the accelerations, are used.
mod column;
mod counts;
mod mistake;
mod rows;

use column::Layout;
use rows::{Head, read_rows};
use servobench_base::Coordinate;

pub use column::Column;
pub use counts::Counts;
pub use mistake::{PointsError, PointsMistake};

/// Largest number of points: a larger table is taken for a mistake.
pub const MOST_POINTS: usize = 5_000_000;

/// Largest position (SI), as for other numbers in tables; a larger one has lost its precision.
const FARTHEST: f64 = 1e30;

/// Points of a move (SI), at least two, in the order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// Kind of the positions: lengths or angles.
    pub motion: Coordinate,
    /// Times (s), strictly increasing.
    pub times: Vec<f64>,
    /// Positions (m or rad), one for each time.
    pub positions: Vec<f64>,
    /// Velocities (m/s or rad/s), one for each time if there is such a column; `None` where a cell is empty.
    pub velocities: Option<Vec<Option<f64>>>,
    /// True if the positions count from the initial position of the axis: those of a table of steps, summed.
    pub is_relative: bool,
    /// Units as written in the heading: time, position, velocity.
    pub units: [Option<String>; 3],
    /// Columns that are not used.
    pub unused: Vec<Column>,
}

/// A profile (SI), at least two points, in the order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Kind of the positions: lengths or angles.
    pub motion: Coordinate,
    /// Times (s), strictly increasing.
    pub times: Vec<f64>,
    /// Velocities or accelerations, one for each time.
    pub values: Vec<f64>,
}

/// Reads a table of points.
///
/// # Errors
/// [`PointsError`], the first mistake.
pub fn read_points(text: &str) -> Result<Points, PointsError> {
    read(text, None, MOST_POINTS)
}

/// Reads a table of points, possibly in counts of a drive: `position [counts]`, `velocity [counts/s]` or `velocity [0.1 counts/s]`.
///
/// # Errors
/// [`PointsError`], the first mistake.
pub fn read_points_in(counts: Option<Counts>, text: &str) -> Result<Points, PointsError> {
    read(text, counts, MOST_POINTS)
}

/// Reads a profile of velocities.
///
/// # Errors
/// [`PointsError`], the first mistake.
pub fn read_velocities(text: &str) -> Result<Profile, PointsError> {
    read_profile(text, Layout::Velocities)
}

/// Reads a profile of accelerations.
///
/// # Errors
/// [`PointsError`], the first mistake.
pub fn read_accelerations(text: &str) -> Result<Profile, PointsError> {
    read_profile(text, Layout::Accelerations)
}

fn read_profile(text: &str, layout: Layout) -> Result<Profile, PointsError> {
    let (mut times, mut values) = (Vec::new(), Vec::new());
    let heads = read_rows(text, layout, None, MOST_POINTS, |column, value| match column {
        Column::Time => times.extend(value),
        _ => values.extend(value),
    })?;
    Ok(Profile { motion: motion(&heads), times, values })
}

/// Reads a table of at most `most` points.
fn read(text: &str, counts: Option<Counts>, most: usize) -> Result<Points, PointsError> {
    let (mut times, mut positions, mut velocities) = (Vec::new(), Vec::new(), Vec::new());
    let mut way = 0.0;
    let heads = read_rows(text, Layout::Positions, counts, most, |column, value| match column {
        Column::Time => times.extend(value),
        Column::Position => positions.extend(value),
        Column::Step => {
            way += value.unwrap_or(0.0);
            positions.push(way);
        }
        _ => velocities.push(value),
    })?;
    if positions.iter().any(|position: &f64| position.abs() > FARTHEST) {
        return Err(PointsError { line: 1, column: 1, mistake: PointsMistake::TooFar });
    }
    let has = |column| heads.iter().any(|head| head.column == column);
    let (has_velocity, is_relative) = (has(Column::Velocity), has(Column::Step));
    let unit = |column| heads.iter().find(|head| head.column == column).map(|head| head.unit.clone());
    let of_positions = if is_relative { Column::Step } else { Column::Position };
    Ok(Points {
        motion: motion(&heads),
        times,
        positions,
        velocities: has_velocity.then_some(velocities),
        is_relative,
        units: [Column::Time, of_positions, Column::Velocity].map(unit),
        unused: heads.iter().map(|head| head.column).filter(|column| !Layout::Positions.uses(*column)).collect(),
    })
}

/// Kind of the values below `heads`: of lengths or of angles.
fn motion(heads: &[Head]) -> Coordinate {
    let is_rotary = heads.iter().any(|head| head.column != Column::Time && head.which == 1);
    if is_rotary { Coordinate::Rotary } else { Coordinate::Linear }
}

#[cfg(test)]
mod tests {
    use super::rows::wrong;
    use super::*;

    #[test]
    fn a_table_is_read_in_si() {
        let text =
            "\u{feff}position [mm], time [ms] ,velocity [m/min]\r\n0,0,0\r\n\r\n 250 , 10,\r\n1e3,+20.5,-30\r\n\r\n";
        let points = read_points(text).unwrap();
        assert_eq!((points.motion, &points.times), (Coordinate::Linear, &vec![0.0, 0.01, 0.0205]));
        assert_eq!(points.positions, [0.0, 0.25, 1.0]);
        assert_eq!(points.velocities, Some(vec![Some(0.0), None, Some(-0.5)]));
        assert_eq!(points.units.map(Option::unwrap), ["ms", "mm", "m/min"]);
    }

    #[test]
    fn steps_count_from_the_point_before() {
        let points = read_points("time [ms],step [mm],velocity [mm/s]\n0,0,0\n10,5,750\n20,10,\n30,-5,0").unwrap();
        let near = points.positions.iter().zip([0.0, 0.005, 0.015, 0.01]).all(|(x, exact)| (x - exact).abs() < 1e-16);
        assert!(near && points.is_relative, "{points:?}");
        assert_eq!(points.units.map(Option::unwrap), ["ms", "mm", "mm/s"]);
        assert!(!read_points("time [ms],position [mm]\n0,0\n1,1").unwrap().is_relative);
        let counts = Some(Counts { per: 2e6, motion: Coordinate::Linear });
        let points = read_points_in(counts, "time [ms],step [counts]\n0,1000\n10,1000").unwrap();
        assert_eq!(points.positions, [5e-4, 1e-3]);
        for (text, said) in [
            (
                "time [ms],step [mm],position [mm]\n0,0,0\n1,1,1",
                "1:21: `position` and `step` both give the positions of the points: delete one",
            ),
            (
                "time [ms],step [mm/s]\n0,0\n1,1",
                "1:11: `step` cannot be in `mm/s`: a length or an angle is needed, this is a velocity (m/s)",
            ),
            (
                "time [ms],step [mm]\n0,\n1,1",
                "2:3: `step` is ``: write a number; only `velocity` beside `position` may be left empty",
            ),
            (
                "time [ms],step [m]\n0,9e29\n1,9e29",
                "1:1: the steps add up to more than 1e30 (SI): check them, and the unit in the heading",
            ),
        ] {
            assert_eq!(read_points(text).unwrap_err().to_string(), said, "{text}");
        }
    }

    #[test]
    fn a_profile_is_times_and_values() {
        let profile = read_velocities("velocity [m/min],time [ms]\n0,0\n30,10").unwrap();
        let expected = Profile { motion: Coordinate::Linear, times: vec![0.0, 0.01], values: vec![0.0, 0.5] };
        assert_eq!(profile, expected);
        let profile = read_accelerations("time [s],acceleration [rad/s2]\n0,0\n1,-2").unwrap();
        let expected = Profile { motion: Coordinate::Rotary, times: vec![0.0, 1.0], values: vec![0.0, -2.0] };
        assert_eq!(profile, expected);
        for (read, text, said) in [
            (
                read_velocities as fn(&str) -> _,
                "",
                "1:1: the table is empty: begin with a heading like `time [ms],velocity [mm/s]`",
            ),
            (
                read_velocities,
                "time [s];velocity [m/s]",
                "1:9: columns are separated by commas, not by `;`: write `time [ms],velocity [mm/s]`, numbers with a point",
            ),
            (read_velocities, "time [s]\n0\n1", "1:1: the column `velocity` is missing: add `velocity [mm/s]`"),
            (
                read_accelerations,
                "time [s],acceleration [m/s]\n",
                "1:10: `acceleration` cannot be in `m/s`: an acceleration or an angular acceleration is needed, this is a \
                 velocity (m/s)",
            ),
            (
                read_accelerations,
                "time [s],acceleration [m/s2]\n0,\n",
                "2:3: `acceleration` is ``: write a number; only `velocity` beside `position` may be left empty",
            ),
        ] {
            let found: Result<Profile, PointsError> = read(text);
            assert_eq!(found.unwrap_err().to_string(), said, "{text}");
        }
    }

    /// A planned move is written with all derivatives; those are checked only as far as they reveal mistakes.
    #[test]
    fn columns_that_are_not_used_may_be_there() {
        let text = "time [s],position [m],velocity [m/s],acceleration [m/s2],jerk [m/s3],snap [m/s4]\n\
                    0,0,0,1,2,3\n1,0.5,1,,,\n";
        let points = read_points(text).unwrap();
        assert_eq!((points.times, points.positions), (vec![0.0, 1.0], vec![0.0, 0.5]));
        assert_eq!(points.velocities, Some(vec![Some(0.0), Some(1.0)]));
        assert_eq!(points.unused, [Column::Acceleration, Column::Jerk, Column::Snap]);
        assert_eq!(read_velocities(text).unwrap().values, [0.0, 1.0]);
        assert_eq!(
            read_accelerations(text).unwrap_err().to_string(),
            "3:9: `acceleration` is ``: write a number; only `velocity` beside `position` may be left empty"
        );
        for (text, said) in [
            (
                "time [s],position [m],jerk [rad/s3]\n0,0,0\n1,1,0",
                "1:23: `jerk` cannot be in `rad/s3`: positions are in `m`, a jerk is needed",
            ),
            (
                "time [s],position [rad],velocity [m/s]\n0,0,0\n1,1,0",
                "1:25: `velocity` cannot be in `m/s`: positions are in `rad`, an angular velocity is needed",
            ),
            (
                "time [s],position [m],snap [m/s4]\n0,0,0\n1,1,x",
                "3:5: `snap` is `x`: write a number like `12.5`; its unit is in the heading",
            ),
            (
                "time [s],position [m],crackle [m/s5]\n0,0,0\n1,1,0",
                "1:23: unknown column `crackle`: the heading is like `time [ms],position [mm],velocity [mm/s]`",
            ),
        ] {
            assert_eq!(read_points(text).unwrap_err().to_string(), said, "{text}");
        }
    }

    /// Oracle: by hand, 10 000 counts on 5 mm.
    #[test]
    fn counts_are_what_they_are_of_the_axis() {
        let counts = |per, motion| Some(Counts { per, motion });
        let linear = counts(2e6, Coordinate::Linear);
        let text = "time [ms],position [counts],velocity [0.1 counts/s]\n0,0,0\n10,10000,-400000\n20,-1,";
        let points = read_points_in(linear, text).unwrap();
        assert_eq!((points.motion, points.positions), (Coordinate::Linear, vec![0.0, 0.005, -0.5e-6]));
        assert_eq!(points.velocities, Some(vec![Some(0.0), Some(-0.02), None]));
        let whole = read_points_in(linear, &text.replace("0.1 counts/s", "counts/s")).unwrap();
        assert_eq!(whole.velocities.unwrap()[1], Some(-0.2));
        let rotary = counts(-1000.0, Coordinate::Rotary);
        let turned = read_points_in(rotary, "time [s],position [counts]\n0,0\n1,500").unwrap();
        assert_eq!((turned.motion, turned.positions[1]), (Coordinate::Rotary, -0.5));
        for (counts, text, said) in [
            (
                None,
                "time [s],position [counts]\n",
                "1:10: `position` cannot be in `counts`: the size of a count on the axis is unknown: give --counts to `servobench \
                 plan`, or `units` to the `[bus]` of a scenario",
            ),
            (
                linear,
                "time [s],position [counts],velocity [counts/ms]\n",
                "1:28: `velocity` cannot be in `counts/ms`: write `counts/s`, or `0.1 counts/s` as drives take it",
            ),
            (linear, "time [counts],position [m]\n", "1:1: `time` cannot be in `counts`: write `ms`"),
            (
                linear,
                "time [s],position [counts],velocity [rad/s]\n",
                "1:28: `velocity` cannot be in `rad/s`: positions are in `counts`, a velocity is needed",
            ),
        ] {
            assert_eq!(read_points_in(counts, text).unwrap_err().to_string(), said, "{text}");
        }
    }

    #[test]
    fn angles_make_a_rotary_axis() {
        let points = read_points("time [s],position [rev]\n0,0\n1,-2").unwrap();
        assert_eq!((points.motion, points.velocities), (Coordinate::Rotary, None));
        assert!((points.positions[1] + 2.0 * std::f64::consts::TAU).abs() < 1e-15);
    }

    /// A number in a column equals the quantity written with its unit exactly.
    #[test]
    fn numbers_are_those_of_quantities() {
        for (number, unit) in
            [("0.1", "um"), ("7.3", "mm"), ("1.7e2", "cm"), ("33", "km"), ("-0.7", "deg"), (".5", "m")]
        {
            let text = format!("time [s],position [{unit}]\n0,0\n1,{number}");
            let quantity = crate::quantity::parse(&format!("{number} {unit}")).unwrap();
            assert_eq!(read_points(&text).unwrap().positions[1].to_bits(), quantity.value.to_bits(), "{number} {unit}");
        }
    }

    #[test]
    fn every_mistake_says_where_it_is_and_the_way_out() {
        let heading = "time [ms],position [mm],velocity [mm/s]\n";
        for (text, said) in [
            ("", "1:1: the table is empty: begin with a heading like `time [ms],position [mm],velocity [mm/s]`"),
            ("\n\ntime,x", "3:1: `time` needs its unit in brackets: write `time [ms]`"),
            ("0,0\n1,1", "1:1: unknown column `0`: the heading is like `time [ms],position [mm],velocity [mm/s]`"),
            (
                "time [ms];position [mm]\n",
                "1:10: columns are separated by commas, not by `;`: write `time [ms],position [mm]`, numbers with a point",
            ),
            ("time [s],time [ms]\n", "1:10: there are two columns `time`: delete one"),
            ("time [s]\n0\n1", "1:1: the column `position` is missing: add `position [mm]`"),
            (
                "time [s],position [s]\n",
                "1:10: `position` cannot be in `s`: a length or an angle is needed, this is a time (s)",
            ),
            ("time [s],position [MM]\n", "1:10: `position` cannot be in `MM`: unknown unit `MM`; did you mean `mm`?"),
            (
                "time [s],position [mm],velocity [rpm]\n",
                "1:24: `velocity` cannot be in `rpm`: positions are in `mm`, a velocity is needed",
            ),
            (
                "time [s],position [mm]\n0,0\n1,x",
                "3:3: `position` is `x`: write a number like `12.5`; its unit is in the heading",
            ),
            ("time [s],position [mm]\n0,0\n1,nan", "3:3: `position` is `nan`: the number must be finite"),
            (
                "time [s],position [mm]\n0,0\n1,1e40",
                "3:3: `position` is `1e40`: the number is too large: above 1e30 in SI",
            ),
            (
                "time [s],position [mm]\n0,\n",
                "2:3: `position` is ``: write a number; only `velocity` beside `position` may be left empty",
            ),
        ] {
            assert_eq!(read_points(text).unwrap_err().to_string(), said, "{text}");
        }
        for (rows, said) in [
            (
                "0,0,0\n1,5,0\n\n1,7,0",
                "5:1: `time` is 0.001 s, not later than 0.001 s at the point before: sort the rows by time and give each a different time",
            ),
            (
                "0,0,0\n1,5",
                "3:1: a row of 2 values below a heading of 3: separate values by commas, with decimal points",
            ),
            (
                "0,0,0\n1,5,0,1",
                "3:1: a row of 4 values below a heading of 3: separate values by commas, with decimal points",
            ),
            (
                "0,0,0\n1;5;0",
                "3:1: a row of 1 values below a heading of 3: separate values by commas, with decimal points",
            ),
            ("0,0,0\n", "2:1: a table needs at least 2 points, this one has 1: add the point where the move ends"),
        ] {
            assert_eq!(read_points(&format!("{heading}{rows}")).unwrap_err().to_string(), said, "{rows}");
        }
    }

    #[test]
    fn a_table_of_absurd_length_is_refused() {
        let text = "time [ms],position [mm]\n0,0\n1,0\n2,0\n3,0";
        assert_eq!(read(text, None, 4).unwrap().times.len(), 4);
        assert_eq!(read(text, None, 3).unwrap_err(), wrong(5, 1, PointsMistake::TooMany { most: 3 }));
    }

    /// Columns count characters, not bytes, and a long cell is shortened.
    #[test]
    fn places_are_those_of_an_editor() {
        let error = read_points(&format!("time [µs],position [µm]\n0,0\n µ,{}", "x".repeat(99))).unwrap_err();
        assert_eq!((error.line, error.column), (3, 2));
        let error = read_points(&format!("time [µs],position [µm]\n0,0\n1,{}", "x".repeat(99))).unwrap_err();
        assert!(error.to_string().chars().count() < 140, "{error}");
    }
}
