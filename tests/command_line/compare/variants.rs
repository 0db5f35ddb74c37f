//! Variants of one scenario, and input shapers as such.
use super::{compare, compared, fits, runs};
use crate::{SLIDE, code, folder, said, servobench};
use std::path::Path;

/// What `run` gives with these values of keys.
fn run_with(file: &str, sets: &[&str], out: &Path) -> serde_json::Value {
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    let arguments: Vec<&str> =
        ["run", file, "--engine", "exact", "--out", out.to_str().unwrap()].into_iter().chain(sets).collect();
    let output = servobench(&arguments);
    assert!([0, 4].contains(&code(&output)), "{}", said(&output));
    runs(out, "results.json").remove(0)
}

/// Oracle: `run` with the same keys, bit for bit; JSON has numbers that read back to the same bits.
#[test]
fn variants_give_what_run_gives_with_the_same_keys() {
    let work = tempfile::tempdir().unwrap();
    let file = "scenarios/demo/snap.toml";
    let two = "setpoint.shaper=[{ kind = \"zv\", frequency = \"17.5 Hz\" }, { kind = 'ei', frequency = '31 Hz', tolerable = 0.1 }]";
    let variants = ["as it is:", "jerk: setpoint.order=3", &format!("two modes: {two}; setpoint.velocity=20m/min")];
    let options = variants.iter().flat_map(|variant| ["--variant", variant]);
    let arguments: Vec<&str> = std::iter::once(file)
        .chain(options)
        .chain(["--shaper", "zvd", "--shaper-frequency", "17.5Hz,31Hz", "--shaper-damping", "0.01"])
        .collect();
    let out = work.path().join("compared");
    let output = compare(&out, &arguments);
    assert!([0, 4].contains(&code(&output)), "{}", said(&output));
    let all = runs(&out, "comparison.json");
    let zvd = "setpoint.shaper=[{ kind = \"zvd\", frequency = \"17.5 Hz\", damping = 0.01 }, { kind = \"zvd\", frequency = \"31 Hz\", damping = 0.01 }]";
    let sets: [&[&str]; 4] = [&[], &["setpoint.order=3"], &[two, "setpoint.velocity=20m/min"], &[zvd]];
    assert_eq!(all.len(), sets.len());
    for (one, sets) in all.iter().zip(sets) {
        let alone = run_with(file, sets, &work.path().join("alone"));
        for part in ["metrics", "moves", "verdict", "overrides", "absent", "duration"] {
            assert_eq!(one[part], alone[part], "{part} with {sets:?}");
        }
    }
}

#[test]
fn every_file_is_run_in_every_variant() {
    let work = folder(&[("axis-one.toml", SLIDE), ("axis-two.toml", &SLIDE.replace("80 Hz", "50 Hz"))]);
    let [one, two, out] = ["axis-one.toml", "axis-two.toml", "out"].map(|name| work.path().join(name));
    let (runs, text) = compared(
        &out,
        &[
            one.to_str().unwrap(),
            two.to_str().unwrap(),
            "--variant",
            "slow: setpoint.acceleration=2m/s2",
            "--variant",
            "fast:",
        ],
    );
    assert_eq!(runs.len(), 4);
    let head: Vec<&str> = text.lines().take(7).collect();
    assert_eq!(
        head,
        [
            "axis-one and axis-two in 2 variants on exact, each at its own limits",
            "  slow  setpoint.acceleration=2m/s2",
            "  fast  as it is",
            "what differs:",
            "  drive.velocity.bandwidth  80 Hz against 50 Hz",
            "",
            "                                one slow     one fast     two slow     two fast",
        ]
    );
    fits(&text);
}

/// Eight runs: each is a row, and what they say is short.
#[test]
fn every_shaper_beside_none_fits_a_terminal() {
    let work = tempfile::tempdir().unwrap();
    let (runs, text) = compared(
        &work.path().join("out"),
        &["scenarios/demo/jerk.toml", "--shaper", "none,all", "--shaper-frequency", "17.31Hz", "--engine", "exact"],
    );
    assert_eq!(runs.len(), 8);
    fits(&text);
    let text = text.lines().filter(|line| !line.starts_with("look at it")).collect::<Vec<_>>().join("\n");
    insta::assert_snapshot!(text, @r#"
    jerk in 8 variants on exact, each at its own limits
      none      no shaper
      zv        shaper zv against 17.31 Hz
      mzv       shaper mzv against 17.31 Hz
      zvd       shaper zvd against 17.31 Hz
      zvdd      shaper zvdd against 17.31 Hz
      ei        shaper ei against 17.31 Hz
      2hump-ei  shaper 2hump-ei against 17.31 Hz
      3hump-ei  shaper 3hump-ei against 17.31 Hz

                        move +  peak error,  peak error,  vibration,    amplitude
                move  settling         load        motor         p-p  of the mode
                   s         s           µm           µm          µm           µm
    none      *0.705      1.68          404         1.79         196          100
    zv         0.734    *0.734          336        0.253        1.98         1.00
    mzv        0.748     0.748          335        0.161        1.20        0.619
    zvd        0.763     0.763          334        0.142       0.139            0
    zvdd       0.792     0.792          321        0.121      0.0765            0
    ei         0.763     0.763          332        0.184        9.58         4.93
    2hump-ei   0.792     0.792          317        0.145       0.570        0.274
    3hump-ei   0.821     0.821         *299        0.117        9.40         4.83

                peak     RMS      RMS  electrical  copper
              torque  torque  current      energy    loss
                 N·m    mN·m    mArms           J       J
    none        1.01     209      407        25.6    3.21
    zv          1.00     204      398        25.4    3.06
    mzv        0.991     203      395        25.3    3.02
    zvd        0.964     200      390        25.1    2.94
    zvdd       0.941     197      382        24.9    2.83
    ei         0.962     200      389        25.1    2.93
    2hump-ei   0.925     195      378        24.8    2.77
    3hump-ei  *0.873    *188     *366       *24.4   *2.60
    * smallest, by more than what counts as equal

    Residual vibration (peak-to-peak): least zvdd 76.5 nm, then zvd 139 nm (82 %
    more) and 2hump-ei 570 nm (7.5 × as much); most none 196 µm (2600 × as much).
    Move: shortest none 705 ms, then zv 734 ms (4.1 % longer) and mzv 748 ms (6.1 %
    longer); longest 3hump-ei 821 ms (16 % longer). Move with settling: shortest zv
    734 ms, then mzv 748 ms (2.0 % longer) and zvd 763 ms (3.9 % longer); longest
    none 1.68 s (2.3 × as long). Peak following error: least 3hump-ei 299 µm, then
    2hump-ei 317 µm (6.0 % more) and zvdd 321 µm (7.4 % more); most none 404 µm
    (35 % more). RMS torque: least 3hump-ei 188 mN·m, then 2hump-ei 195 mN·m (3.3 %
    more) and zvdd 197 mN·m (4.4 % more); most none 209 mN·m (11 % more). The load
    rings at 17.31 Hz (ζ = 0.0064). The choice is between zv, mzv and zvd; none,
    zvdd, ei, 2hump-ei and 3hump-ei are beaten by one that leaves no more residual
    vibration and is in position no later.
    "#);
}

#[test]
fn what_is_wrong_with_variants_is_said() {
    let own =
        SLIDE.replace("move_to = \"50 mm\"", "move_to = \"50 mm\"\nshaper = { kind = \"zv\", frequency = \"40 Hz\" }");
    let work = folder(&[("a.toml", SLIDE), ("own.toml", &own)]);
    let [a, own, out] = ["a.toml", "own.toml", "out"].map(|name| work.path().join(name));
    let (a, own) = (a.to_str().unwrap(), own.to_str().unwrap());
    for (arguments, part) in [
        (&[a][..], "a comparison needs two runs at least"),
        (&[a, "--variant", "one:"], "a comparison needs two runs at least"),
        (&[a, "--variant", "setpoint.order=3"], "there is no name with a colon"),
        (&[a, "--variant", "one:", "--variant", "one: setpoint.order=2"], "two are called `one`"),
        (&[a, "--variant", "one:", "--variant", "limit:"], "the label `limit`, which is reserved"),
        (&[a, "--variant", "one:", "--variant", "two: setpoint.ordre=2"], "variant `two` of"),
        (&[a, "--shaper", "zv,zvd"], "`a` names no mode: give its frequency"),
        (&[a, "--shaper", "zv,zzz", "--shaper-frequency", "40Hz"], "invalid value 'zzz'"),
        (&[a, "--shaper", "all", "--shaper-frequency", "40"], "a frequency needs its unit"),
        (
            &[a, "--shaper", "all", "--shaper-frequency", "40Hz", "--shaper-damping", "0,0"],
            "2 damping ratios for 1 modes",
        ),
        (&[own, "--shaper", "all", "--shaper-frequency", "40Hz"], "`program.0.shaper.kind` to one move"),
        (&[a, "--shaper-frequency", "40Hz"], "--shaper"),
    ] {
        let output = compare(&out, arguments);
        assert_eq!(code(&output), 2, "{arguments:?}: {}", said(&output));
        let words = said(&output).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(part), "{arguments:?}: {words}");
        assert!(!out.exists());
    }
}
