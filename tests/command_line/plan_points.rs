//! Moves as tables of points, and back.
use super::{code, folder, json, said, servobench};
use serde_json::Value;
use servobench_cia402::interpolated::serial::Record;
use servobench_cia402::interpolated::{Point, SegmentCommand};
use std::fs;
use std::path::Path;

/// Every time is a whole number of 10 ms.
const S_CURVE: &str = "--order 3 --distance 1m --velocity 1m/s --acceleration 5m/s2 --jerk 50m/s3 --sample-time 10ms";

fn plan(line: &str) -> String {
    let output = servobench(&["plan"].into_iter().chain(line.split_whitespace()).collect::<Vec<_>>());
    assert_eq!(code(&output), 0, "{line}: {}", said(&output));
    said(&output)
}

fn json_of(line: &str) -> Value {
    let output = servobench(&["plan"].into_iter().chain(line.split_whitespace()).chain(["--json"]).collect::<Vec<_>>());
    assert_eq!(code(&output), 0, "{line}: {}", said(&output));
    json(&output.stdout)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn name(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Oracle: the closed form of the S-curve (1 m, 1 m/s, 5 m/s², 50 m/s³: 0.1 s of jerk, 0.1 s of constant acceleration, 0.7 s of cruise, 1.3 s
/// in all, all of them whole multiples of 10 ms). Its jerk is constant between its samples, where the way through the points is a cubic:
/// the same one.
#[test]
fn what_plan_writes_plan_reads() {
    let work = folder(&[]);
    let csv = work.path().join("move.csv");
    plan(&format!("{S_CURVE} --csv {}", name(&csv)));
    let said = plan(&format!("pvt --points {}", name(&csv)));
    assert!(said.contains("move of 1 m through 131 points in 1.3 s"), "{said}");
    assert!(said.contains("not used of the table: acceleration, jerk, snap;"), "{said}");
    let again = json_of(&format!("pvt --points {}", name(&csv)));
    assert!((number(&again["duration_s"]) - 1.3).abs() < 1e-12);
    // Second and third differences of positions over 10 ms magnify rounding of 1e-16 by 1e4·6 and 1e6·12.
    for (derivative, peak, rounding) in [("velocity", 1.0, 1e-12), ("acceleration", 5.0, 1e-10), ("jerk", 50.0, 1e-7)] {
        let found = number(&again["peaks"][derivative]);
        assert!((found - peak).abs() < rounding, "{derivative}: {found}");
    }
}

/// The same table in a program and in a profile block.
#[test]
fn scenarios_read_what_plan_writes() {
    let axis = "[run]\nbase_rate = \"4 kHz\"\nduration = \"2 s\"\n[axis]\nmotion = \"linear\"\n[axis.motor_side]\nmass = \"20 kg\"\n\
                [motor]\nkind = \"ideal-source\"\nlimit = \"1 kN\"\n[drive.velocity]\nrate = \"4 kHz\"\nbandwidth = \"80 Hz\"\nkind = \"p\"\n\
                [drive.position]\nrate = \"4 kHz\"\nbandwidth = \"10 Hz\"\n";
    let program = format!("{axis}[[program]]\ntable = {{ file = \"move.csv\" }}\n");
    let bus = "[bus]\ncycle = \"1 ms\"\nmotion_cycle = \"4 ms\"\nunits = { drive = 1, axis = \"1 um\" }\n[plc]\nhoming_required = false\n";
    let calls = "[[call]]\nblock = \"MC_Power\"\nname = \"power\"\n[[call]]\nblock = \"MC_PositionProfile\"\nname = \"go\"\n\
                 start = \"power.Status\"\ntable = { file = \"move.csv\" }\n";
    let work = folder(&[("program.toml", &program), ("block.toml", &format!("{axis}{bus}{calls}"))]);
    plan(&format!("{S_CURVE} --csv {} --csv-step 20ms", name(&work.path().join("move.csv"))));
    for (file, warns) in [("program.toml", false), ("block.toml", true)] {
        let output = servobench(&["run", name(&work.path().join(file))]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        let warning = "MC_PositionProfile chooses the velocities itself";
        assert_eq!(said(&output).contains(warning), warns, "{}", said(&output));
    }
}

fn cells(path: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(path).unwrap();
    text.lines().skip(1).map(|row| row.split(',').map(str::to_owned).collect()).collect()
}

fn positions(path: &Path) -> Vec<f64> {
    cells(path).iter().map(|row| row[1].parse().unwrap()).collect()
}

/// Off every grid: its segments end between the points.
const ODD: &str = "--order 4 --distance 123.4mm --velocity 0.7m/s --acceleration 6m/s2 --jerk 150m/s3 --snap 9000m/s4";

/// Oracle: both moves in steps of 0.1 ms, each as its own plan writes it. What is announced is their largest difference, which may lie
/// between two steps: it changes by no more than the velocities differ there, below 1 mm/s, or beside held set-points by the whole velocity of the
/// way, below 0.75 m/s.
#[test]
fn the_way_through_points_deviates_as_announced() {
    let work = folder(&[]);
    let [points, ours, theirs] = ["points.csv", "ours.csv", "theirs.csv"].map(|file| work.path().join(file));
    for (line, time) in [
        (ODD.to_owned(), "10ms"),
        (ODD.to_owned(), "17ms"),
        (format!("{ODD} --sample-time 3ms --execution euler"), "7ms"),
        (
            "rockwell --distance -50mm --velocity 0.3m/s --acceleration 4m/s2 --jerk-percent-of-time 60".to_owned(),
            "15ms",
        ),
        (format!("{ODD} --start-velocity 0.2m/s"), "10ms"),
    ] {
        let written =
            format!("{line} --pvt {} --point-time {time} --csv {} --csv-step 0.1ms", name(&points), name(&ours));
        let announced = json_of(&written);
        plan(&format!("pvt --points {} --csv {} --csv-step 0.1ms", name(&points), name(&theirs)));
        let (ours, theirs) = (positions(&ours), positions(&theirs));
        assert!(ours.len().abs_diff(theirs.len()) <= 10, "{line}");
        let seen = ours.iter().zip(&theirs).fold(0.0_f64, |most, (one, two)| most.max((one - two).abs()));
        let deviation = number(&announced["point_deviation"]);
        let between = if line.contains("euler") { 0.75e-4 } else { 1e-7 };
        assert!(
            seen <= deviation + 1e-12 && deviation <= seen + between && deviation > 1e-8,
            "{line}: {deviation} {seen}"
        );
        let asked = time.trim_end_matches("ms").parse::<f64>().unwrap() / 1e3;
        assert!((number(&announced["point_time_s"]) - asked).abs() < 1e-12);
    }
}

/// What a decoder of the drive's words makes of them are the points again, to half a count and half a tenth of a count per second.
#[test]
fn words_are_the_points() {
    let work = folder(&[]);
    let [points, words] = ["points.csv", "words.csv"].map(|file| work.path().join(file));
    let hex = |text: &str| u32::from_str_radix(text.trim_start_matches("0x"), 16).unwrap();
    for (counts, per_metre) in [("10000/5mm", 2e6), ("-1000/mm", -1e6)] {
        for transfer in ["2010h", "60C1h", "115h"] {
            let line = format!("{ODD} --pvt {} --words {} --counts {counts}", name(&points), name(&words));
            let announced = json_of(&format!("{line} --trajectory-buffer {transfer}"));
            // Half a count at both ends of a segment is one in its middle at most, with the velocities a little more.
            let count = 1.0 / f64::abs(per_metre);
            assert!(number(&announced["sent_deviation"]) <= number(&announced["point_deviation"]) + 1.1 * count);
            let (points, words) = (cells(&points), cells(&words));
            assert_eq!(points.len(), words.len());
            let mut position = 0;
            for (number, (point, row)) in points.iter().zip(&words).enumerate() {
                let sent = match transfer {
                    "2010h" => {
                        let bytes: Vec<u8> =
                            row[5].split(' ').map(|byte| u8::from_str_radix(byte, 16).unwrap()).collect();
                        match SegmentCommand::decode(bytes.try_into().unwrap()).unwrap() {
                            SegmentCommand::Point { counter, point } => {
                                assert_eq!(usize::from(counter), number % 8);
                                point
                            }
                            other => panic!("{other:?}"),
                        }
                    }
                    "115h" => {
                        let values: Vec<i32> = row[6..]
                            .iter()
                            .filter(|word| !word.is_empty())
                            .map(|word| hex(word).cast_signed())
                            .collect();
                        match Record::decode(hex(&row[5]).try_into().unwrap(), &values).unwrap() {
                            Record::Point(point) => point,
                            other => panic!("{other:?}"),
                        }
                    }
                    _ => Point {
                        position: hex(&row[5]).cast_signed(),
                        is_relative: false,
                        time: 1000 * hex(&row[6]),
                        velocity: Some(hex(&row[7]).cast_signed()),
                    },
                };
                position = if sent.is_relative { position + sent.position } else { sent.position };
                let asked: Vec<f64> = point.iter().map(|cell| cell.parse().unwrap()).collect();
                assert!((f64::from(position) - asked[1] * per_metre).abs() <= 0.5 + 1e-6, "{point:?} {row:?}");
                if let Some(velocity) = sent.velocity {
                    // 2010h says velocities that do not fit into 24 bits in tens of counts per second.
                    let unit = if transfer == "2010h" && velocity.abs() > 8_388_607 { 100.0 } else { 1.0 };
                    let asked = asked[2] * per_metre * 10.0;
                    assert!((f64::from(velocity) - asked).abs() <= 0.5 * unit + 1e-6, "{point:?} {row:?}");
                }
                let next =
                    points.get(number + 1).map_or(0.0, |next| 1e6 * (next[0].parse::<f64>().unwrap() - asked[0]));
                assert!((f64::from(sent.time) - next).abs() < 1e-3, "{point:?} {row:?}");
                // What stands beside the words says the same.
                assert_eq!(row[1], position.to_string());
            }
        }
    }
}

/// A table is sent as it is: its own points, of which one that is approached linearly has no velocity.
#[test]
fn a_table_has_its_own_points() {
    let table = "time [s],position [m],velocity [m/s]\n0,0.1,0\n0.1,0.2,1.5\n0.15,0.25,\n0.3,0.1,0\n";
    let work = folder(&[("table.csv", table)]);
    let [again, words] = ["again.csv", "words.csv"].map(|file| work.path().join(file));
    let said = plan(&format!(
        "pvt --points {} --pvt {} --words {} --counts 1000/mm",
        name(&work.path().join("table.csv")),
        name(&again),
        name(&words)
    ));
    assert!(said.contains("4 points, its own: the way through them is on the plan"), "{said}");
    assert_eq!(fs::read_to_string(again).unwrap(), table);
    let rows = cells(&words);
    // Relative to where the move begins; formats 2, 3 and 6.
    assert_eq!(rows[0][2], "0");
    let format = |row: &[String]| u8::from_str_radix(&row[5][..2], 16).unwrap() >> 3;
    assert_eq!(rows.iter().map(|row| format(row)).collect::<Vec<_>>(), [2, 3, 6, 2]);
    assert_eq!((rows[2][3].as_str(), rows[3][4].as_str()), ("", "0"));
}

/// What exceeds limits is told, and drawn; points are marked while they can be told apart.
#[test]
fn tables_are_held_against_limits() {
    let rows: Vec<_> = (0..=10).map(|k| format!("{},{}\n", 20 * k, k * k)).collect();
    let many: Vec<_> = (0..=200).map(|k| format!("{},{k}\n", 20 * k)).collect();
    let heading = "time [ms],position [mm]\n";
    let work = folder(&[
        ("table.csv", &(heading.to_owned() + &rows.concat())),
        ("many.csv", &(heading.to_owned() + &many.concat())),
    ]);
    let svg = work.path().join("table.svg");
    let line = |file: &str| {
        let limits = "--velocities continuous --velocity 0.8m/s --acceleration 1000m/s2";
        format!("pvt --points {} {limits} --svg {}", name(&work.path().join(file)), name(&svg))
    };
    let said = plan(&line("table.csv"));
    // From 81 mm to 100 mm in 20 ms the mean velocity is 0.95 m/s.
    assert!(said.contains("exceeds its limit of velocity by ") && !said.contains("and of acceleration"), "{said}");
    let drawn = fs::read_to_string(&svg).unwrap();
    assert!(drawn.contains(">limit 800 mm/s<") || drawn.contains(">limit 0.8 m/s<"), "{drawn}");
    // Eleven in each of two panels, and one in the key.
    assert_eq!(drawn.matches("<circle class=\"p\"").count(), 23);
    plan(&line("many.csv"));
    assert_eq!(fs::read_to_string(&svg).unwrap().matches("<circle").count(), 0);
    plan(&format!("{} --from 1s --to 2s", line("many.csv")));
    assert_eq!(fs::read_to_string(&svg).unwrap().matches("<circle").count(), 2 * 51 + 1);
}

/// A table in counts is the one in millimetres: 10 000 counts on 5 mm.
#[test]
fn tables_in_counts() {
    let counts = "time [ms],position [counts],velocity [0.1 counts/s]\n0,0,0\n20,4000,4000000\n40,8000,0\n";
    let lengths = "time [ms],position [mm],velocity [mm/s]\n0,0,0\n20,2,200\n40,4,0\n";
    let work = folder(&[("counts.csv", counts), ("lengths.csv", lengths)]);
    let path = |file: &str| name(&work.path().join(file)).to_owned();
    let [one, two] =
        ["counts.csv", "lengths.csv"].map(|file| json_of(&format!("pvt --points {} --counts 10000/5mm", path(file))));
    assert_eq!(one, two);
    let output = servobench(&["plan", "pvt", "--points", &path("counts.csv")]);
    assert_eq!(code(&output), 2);
    assert!(said(&output).contains("1:11: `position` cannot be in `counts`"), "{}", said(&output));
    assert!(plan(&format!("{ODD} --counts 1000/mm")).contains("--counts are not used"));
}

#[test]
fn points_that_cannot_be_are_refused_before_a_file_is_written() {
    let work = folder(&[]);
    let out = work.path().join("out.csv");
    let table = name(&out);
    for (line, expected) in [
        (
            format!("{ODD} --pvt {table} --point-time 0.001ns"),
            "--point-time must be long enough for at most 5 million points",
        ),
        (
            format!("{ODD} --pvt {table} --allowed-deviation 1e-9nm"),
            "--allowed-deviation must be what points every millisecond keep",
        ),
        (format!("{ODD} --pvt {table} --allowed-deviation 1deg"), "--allowed-deviation `1deg`: a length is needed"),
        (format!("{ODD} --words {table} --counts 1000/rev"), "--counts `1 rev`: a length is needed"),
        (format!("{ODD} --words {table} --counts 1000"), "write counts and what they are of the axis"),
        (format!("{ODD} --words {table} --counts nan/mm"), "the number of counts must be finite and not 0"),
        (format!("{ODD} --words {table} --counts 0/mm"), "the number of counts must be finite and not 0"),
        (format!("{ODD} --words {table} --counts 1/0mm"), "counts of no way mean nothing"),
        (format!("{ODD} --words {table}"), "--counts <COUNTS>"),
        (format!("{ODD} --words {table} --counts 1000/mm --point-time 0.5ms"), "whole milliseconds up to 255"),
        (format!("{ODD} --words {table} --counts 1000/mm --point-time 256ms"), "whole milliseconds up to 255"),
        (format!("{ODD} --words {table} --counts 1e9/mm"), "--words: point 2 of the table: a velocity in 0.1 counts/s"),
        (format!("{ODD} --pvt {table} --point-time 1ms --allowed-deviation 1um"), "cannot be used with"),
    ] {
        let output = servobench(&["plan"].into_iter().chain(line.split_whitespace()).collect::<Vec<_>>());
        assert_eq!(code(&output), 2, "{line}: {}", said(&output));
        assert!(said(&output).contains(expected), "{line}: {}", said(&output));
        assert_eq!(fs::read_dir(work.path()).unwrap().count(), 0, "{line}");
    }
}
