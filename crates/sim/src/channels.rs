//! The recorded channels: their names, units and writers, and the row of one tick.
use crate::error::BuildError;
use crate::limit_watch::PerLimit;
use servobench_base::{Rate, Setpoint};
use servobench_plant::BodyState;
use servobench_trace::{About, ChannelSpec, Recorder};

/// All that is known at tick k, before the integration to k+1.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Instant {
    pub(crate) setpoint: Setpoint,
    /// Bodies in the axis coordinate: motor, table (the middle one), load.
    pub(crate) motor: BodyState,
    pub(crate) table: BodyState,
    pub(crate) load: BodyState,
    pub(crate) reference: f64,
    pub(crate) motor_reference: f64,
    /// Reference less position, of motor and load.
    pub(crate) following_error: [f64; 2],
    pub(crate) velocity_reference: f64,
    pub(crate) effort_reference: f64,
    pub(crate) effort: f64,
    pub(crate) current: servobench_base::Dq,
    pub(crate) current_reference: f64,
    /// What the current loop computes at this tick, and what the inverter gives over the coming one.
    pub(crate) voltage_reference: servobench_base::Dq,
    pub(crate) voltage: servobench_base::Dq,
    /// Mean powers over the tick that ends here.
    pub(crate) power: servobench_plant::pmsm::Power,
    pub(crate) shaft_power: f64,
    pub(crate) output: f64,
    /// Set-point of the motion task, before it goes over the bus.
    pub(crate) task: Setpoint,
    /// Actual position as the master reads it.
    pub(crate) bus_position: f64,
    /// External efforts over the coming tick: on the motor in its own coordinate, on the load in the axis coordinate.
    pub(crate) motor_disturbance: f64,
    pub(crate) load_disturbance: f64,
    /// Which limits bind at this tick, and in which share of the ticks since the last row they did.
    pub(crate) binds: PerLimit<bool>,
    pub(crate) saturation: PerLimit<f64>,
}

/// Which channels an axis has.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Equipment {
    /// Unit of positions on the axis, `m` or `rad`.
    pub(crate) axis_unit: &'static str,
    /// Unit of the motor's effort, `N` or `N m`.
    pub(crate) effort_unit: &'static str,
    /// Whether there is a body between motor and load.
    pub(crate) table: bool,
    /// Unit of an effort on the load, `N` or `N m`.
    pub(crate) load_effort_unit: &'static str,
    /// Whether something disturbs the motor, and the load.
    pub(crate) disturbed: [bool; 2],
    /// Whether there is a fieldbus between the motion task and the drive.
    pub(crate) bus: bool,
    /// What the firmware commands; `None` without firmware.
    pub(crate) amplifier: Option<Amplifier>,
    /// What the motor has: by the firmware, or by an FMU in its place.
    pub(crate) motor: Motor,
}

/// What there is of a motor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Motor {
    /// Nothing: it is off, or follows the set-point exactly.
    Motion,
    /// An effort.
    Effort,
    /// Currents and voltages too.
    Currents,
}

/// What the firmware commands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Amplifier {
    /// The currents of a synchronous motor.
    Current,
    /// An ideal source, whose output has this unit.
    Ideal { output_unit: &'static str },
}

/// Rates of the writers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WriterRates {
    pub(crate) base: Rate,
    pub(crate) position: Rate,
    pub(crate) velocity: Rate,
    pub(crate) current: Rate,
    /// Of the motion task and of the bus.
    pub(crate) task: Rate,
    pub(crate) bus: Rate,
}

/// How many channels there are.
const COUNT: usize = 41;

/// Every channel there is, in the order of [`row`].
fn all(equipment: &Equipment, rates: &WriterRates) -> [(bool, ChannelSpec); COUNT] {
    let u = equipment.axis_unit;
    let (e, drive) = (equipment.effort_unit, equipment.amplifier.is_some());
    let (currents, current) = (equipment.motor == Motor::Currents, equipment.amplifier == Some(Amplifier::Current));
    let output_unit = match equipment.amplifier {
        Some(Amplifier::Ideal { output_unit }) => Some(output_unit),
        _ => None,
    };
    let per = |unit: &str, power: &str| format!("{unit}/s{power}");
    let channel = |there: bool, name: &str, unit: String, writer: &str, rate: Rate| {
        (there, ChannelSpec { name: name.into(), unit, writer: writer.into(), rate })
    };
    let setpoint = |name: &str, unit: String| channel(true, name, unit, "set-point", rates.base);
    let mechanics = |there: bool, name: &str, unit: String| channel(there, name, unit, "mechanics", rates.base);
    let position_loop = |name: &str, unit: String| channel(drive, name, unit, "position loop", rates.position);
    let velocity_loop = |name: &str, unit: String| channel(drive, name, unit, "velocity loop", rates.velocity);
    let current_loop = |name: &str, unit: &str| channel(current, name, unit.into(), "current loop", rates.current);
    let commanding = if current { "current loop" } else { "controller" };
    let reference = |name: &str| channel(currents, name, "V".into(), commanding, rates.current);
    let voltage = |name: &str| channel(currents, name, "V".into(), "power stage", rates.base);
    let power = |there: bool, name: &str| channel(there, name, "W".into(), "power stage", rates.base);
    let [on_motor, on_load] = equipment.disturbed;
    let disturbance =
        |there: bool, name: &str, unit: &str| channel(there, name, unit.into(), "disturbance", rates.base);
    [
        channel(equipment.bus, "task.position", u.into(), "motion task", rates.task),
        channel(equipment.bus, "task.velocity", per(u, ""), "motion task", rates.task),
        channel(equipment.bus, "bus.position", u.into(), "fieldbus", rates.bus),
        setpoint("setpoint.position", u.into()),
        setpoint("setpoint.velocity", per(u, "")),
        setpoint("setpoint.acceleration", per(u, "²")),
        setpoint("setpoint.jerk", per(u, "³")),
        setpoint("setpoint.snap", per(u, "⁴")),
        mechanics(true, "motor.position", u.into()),
        mechanics(true, "motor.velocity", per(u, "")),
        mechanics(equipment.table, "table.position", u.into()),
        mechanics(equipment.table, "table.velocity", per(u, "")),
        mechanics(true, "load.position", u.into()),
        mechanics(true, "load.velocity", per(u, "")),
        position_loop("reference.position", u.into()),
        position_loop("reference.motor_position", u.into()),
        velocity_loop("velocity.reference", per(u, "")),
        channel(true, "following_error.motor", u.into(), "measurement", rates.base),
        channel(true, "following_error.load", u.into(), "measurement", rates.base),
        velocity_loop("effort.reference", e.into()),
        channel(equipment.motor != Motor::Motion, "effort.motor", e.into(), "power stage", rates.base),
        channel(currents, "current.d", "A".into(), "motor", rates.base),
        channel(currents, "current.q", "A".into(), "motor", rates.base),
        current_loop("current.q_reference", "A"),
        reference("voltage.d_reference"),
        reference("voltage.q_reference"),
        voltage("voltage.d"),
        voltage("voltage.q"),
        voltage("voltage.magnitude"),
        power(currents, "power.electrical"),
        power(currents, "power.copper"),
        power(currents, "power.stored"),
        power(currents, "power.air_gap"),
        power(equipment.motor != Motor::Motion, "power.shaft"),
        power(currents, "power.residual"),
        channel(
            output_unit.is_some(),
            "command.output",
            output_unit.unwrap_or_default().into(),
            "power stage",
            rates.base,
        ),
        current_loop("saturation.voltage", ""),
        channel(current, "saturation.current", String::new(), "velocity loop", rates.velocity),
        velocity_loop("saturation.effort", String::new()),
        disturbance(on_motor, "disturbance.motor", e),
        disturbance(on_load, "disturbance.load", equipment.load_effort_unit),
    ]
}

/// The values of `now` in the order of [`all`].
#[inline]
fn row(now: &Instant) -> [f64; COUNT] {
    let Setpoint { x, v, a, j, s } = now.setpoint;
    [
        now.task.x,
        now.task.v,
        now.bus_position,
        x,
        v,
        a,
        j,
        s,
        now.motor.position,
        now.motor.velocity,
        now.table.position,
        now.table.velocity,
        now.load.position,
        now.load.velocity,
        now.reference,
        now.motor_reference,
        now.velocity_reference,
        now.following_error[0],
        now.following_error[1],
        now.effort_reference,
        now.effort,
        now.current.d,
        now.current.q,
        now.current_reference,
        now.voltage_reference.d,
        now.voltage_reference.q,
        now.voltage.d,
        now.voltage.q,
        now.voltage.magnitude(),
        now.power.electrical,
        now.power.copper,
        now.power.stored,
        now.power.air_gap,
        now.shaft_power,
        now.power.air_gap - now.shaft_power,
        now.output,
        now.saturation.voltage,
        now.saturation.current,
        now.saturation.effort,
        now.motor_disturbance,
        now.load_disturbance,
    ]
}

/// Writes the values of `now` to a row of [`Selection::recorder`].
///
/// # Panics
/// When the row is that of another recorder.
#[inline]
pub(crate) fn write(now: &Instant, to: &mut [f64]) {
    let to: &mut [f64; COUNT] = to.try_into().expect("a row has room for each channel");
    *to = row(now);
}

/// The channels to keep and where they stand in a row.
#[derive(Debug, Clone)]
pub(crate) struct Selection {
    pub(crate) specs: Vec<ChannelSpec>,
    columns: Vec<usize>,
    kept: Vec<f64>,
}

impl Selection {
    /// Of these channels those `wanted`, or all when the list is empty.
    pub(crate) fn named(&self, wanted: &[impl AsRef<str>]) -> Result<Self, BuildError> {
        if wanted.is_empty() {
            return Ok(self.clone());
        }
        let places: Result<Vec<usize>, &str> =
            wanted.iter().map(AsRef::as_ref).map(|name| self.place(name).ok_or(name)).collect();
        let mut places = places.map_err(|unknown| BuildError::UnknownChannel {
            name: unknown.into(),
            available: self.names().map(String::from).collect(),
        })?;
        places.sort_unstable();
        places.dedup();
        Ok(self.only(&places))
    }

    /// Names of the channels.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.specs.iter().map(|spec| spec.name.as_str())
    }

    /// Where the channel `name` is among them.
    pub(crate) fn place(&self, name: &str) -> Option<usize> {
        self.names().position(|one| one == name)
    }

    /// Those at `places`, in that order.
    pub(crate) fn only(&self, places: &[usize]) -> Self {
        Self {
            specs: places.iter().map(|at| self.specs[*at].clone()).collect(),
            columns: places.iter().map(|at| self.columns[*at]).collect(),
            kept: vec![0.0; places.len()],
        }
    }

    /// Keeps every channel that the axis has.
    pub(crate) fn all(equipment: &Equipment, rates: &WriterRates) -> Self {
        let there = all(equipment, rates).into_iter().enumerate().filter(|(_, (there, _))| *there);
        let (columns, specs): (Vec<_>, Vec<_>) = there.map(|(column, (_, spec))| (column, spec)).unzip();
        let kept = vec![0.0; columns.len()];
        Self { specs, columns, kept }
    }

    /// A recorder of them, for [`write`], with room for `rows` rows.
    pub(crate) fn recorder(&self, about: About, rate: Rate, rows: usize) -> Recorder {
        Recorder::new(about, rate, self.specs.clone(), rows).with_rows(COUNT, self.columns.clone())
    }

    /// The kept values of `now`.
    pub(crate) fn pick(&mut self, now: &Instant) -> &[f64] {
        let row = row(now);
        for (kept, column) in self.kept.iter_mut().zip(&self.columns) {
            *kept = row[*column];
        }
        &self.kept
    }
}
