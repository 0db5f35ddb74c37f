//! The blocks of the firmware that answer real hardware: each scenario passes as it is, and fails without its block or with another
//! value.
use crate::{code, said, servobench};

/// `scenarios/hardware/NAME.toml` passes, and fails with each of these keys.
fn passes_but_not_with(name: &str, others: &[&str]) {
    let file = format!("scenarios/hardware/{name}.toml");
    let out = tempfile::tempdir().unwrap();
    let arguments = ["run", &file, "--quiet", "--keep", "none", "--out", out.path().to_str().unwrap()];
    let output = servobench(&arguments);
    assert_eq!(code(&output), 0, "{name}: {}", said(&output));
    for other in others {
        let output = servobench(&[&arguments[..], &["--set", other]].concat());
        assert_eq!(code(&output), 4, "{name} with {other}: {}", said(&output));
    }
}

#[test]
fn a_notch_takes_the_resonance_out_of_the_loop() {
    passes_but_not_with("notch-filter", &["drive.filter=[]", "drive.filter[0].frequency='1280 Hz'"]);
}

/// Half of the voltage is as little as none.
#[test]
fn field_weakening_takes_the_motor_beyond_its_back_emf() {
    let others = ["drive.current.field_weakening=false", "drive.current.field_weakening_share=0.475"];
    passes_but_not_with("field-weakening", &others);
}

#[test]
fn maximum_torque_per_ampere_saves_copper_loss() {
    passes_but_not_with("mtpa", &["drive.current.strategy=d-reference"]);
}

#[test]
fn i2t_keeps_to_the_continuous_current() {
    let others = ["drive.i2t={}", "drive.i2t.motor.continuous_current='6.4 Arms'", "drive.i2t.motor.peak_time='0.8 s'"];
    passes_but_not_with("i2t", &others);
}

#[test]
fn a_weight_on_the_reference_takes_the_peak_torque() {
    passes_but_not_with(
        "reference-weight",
        &["drive.velocity.reference_weight=1", "drive.velocity.reference_weight=0"],
    );
}

/// Where the load is never reached, or derates, the fault that the scenario expects does not come.
#[test]
fn i2t_is_told_as_a_fault() {
    let others = ["drive.i2t={}", "drive.i2t.motor.reaction=derate", "drive.i2t.motor.continuous_current='6.4 Arms'"];
    passes_but_not_with("i2t-fault", &others);
}
