//! A preview as a person reads it: one screen of 80 columns, or one line.
use super::{EngineSteps, Inertias, LoopBandwidth, Modes, Preview};
use servobench_config::Choice as _;
use servobench_metrics::Quantity;
use servobench_plant::{Integrator, Mode};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Columns of a screen.
const WIDTH: usize = 80;
/// Columns of the names on its left, with the space before them.
const NAMES: usize = 12;

impl Preview {
    /// Everything, as lines of 80 columns: 24 at most.
    #[must_use]
    pub fn screen(&self) -> String {
        let mut screen = Screen::default();
        self.program_lines(&mut screen);
        self.demand_lines(&mut screen);
        if let Some(inertias) = &self.inertias {
            screen.line("inertia", &inertia(inertias));
        }
        match &self.modes {
            Some(modes) => mode_lines(modes, &mut screen),
            None => screen
                .line("modes", &["not known without a run: a file of the user's describes the mechanics".to_owned()]),
        }
        for engine in &self.engines {
            screen.line(engine.engine.name(), &[steps(engine)]);
        }
        let loops: Vec<_> = self.loops.iter().map(bandwidth).collect();
        screen.line("loops", &loops);
        screen.line("stable", &self.stability.words());
        let delays: Vec<_> =
            self.delays.iter().map(|delay| format!("{} {}", delay.name, Quantity::new(delay.length, "s"))).collect();
        screen.line("delays", &delays);
        self.cost_line(&mut screen);
        let models: Vec<_> = self.models.iter().map(|(table, file)| format!("{table} {file}")).collect();
        if !models.is_empty() {
            screen.line("models", &models);
        }
        screen.text
    }

    /// The most important values in one line.
    #[must_use]
    pub fn line(&self) -> String {
        let mut parts = vec![self.program_words()];
        if let Some(effort) = self.demand.effort.filter(|effort| effort.available.is_finite()) {
            parts.push(format!("effort {}", share(effort.peak, effort.available)));
        }
        if let Some(voltage) = self.demand.voltage {
            parts.push(format!("voltage {}", share(voltage.peak, voltage.available)));
        }
        if let Some(mode) = self.modes.as_ref().and_then(Modes::fastest) {
            parts.push(format!("mode {}", Quantity::new(mode.omega / TAU, "Hz")));
        }
        parts.join(", ")
    }

    fn program_words(&self) -> String {
        let moves = self.program.moves.len();
        let end = Quantity::new(self.program.end, "s");
        match moves {
            0 if self.program.by_blocks => "moves by function blocks".into(),
            0 => "no move".into(),
            1 => format!("1 move, {end}"),
            _ => format!("{moves} moves, {end}"),
        }
    }

    fn program_lines(&self, screen: &mut Screen) {
        let mut words = vec![self.program_words()];
        if let Some(longest) = self.program.longest().filter(|_| self.program.moves.len() > 1) {
            words.push(format!("the longest {}", Quantity::new(longest, "s")));
        }
        words.push(format!("run {}", Quantity::new(self.program.run, "s")));
        screen.line("program", &words);
        if self.program.moves.is_empty() {
            return;
        }
        let unit = self.program.axis_unit;
        let peaks = (1..).zip(self.program.peaks()).filter(|(_, peak)| peak.is_finite());
        let peaks: Vec<_> = peaks.map(|(k, peak)| self.program.units.unit(k).pretty().short(peak)).collect();
        screen.line("peaks", &peaks);
        if let Some(error) = self.program.position_error {
            let error = Quantity::new(error, unit);
            if self.program.by_points {
                screen.line("points", &[format!("the way through them is at most {error} off the move")]);
            } else {
                screen.line("profiles", &[format!("velocity commands: at most {error} off their points or spline")]);
            }
        }
    }

    fn demand_lines(&self, screen: &mut Screen) {
        let demand = &self.demand;
        let show = |value, unit| Quantity::new(value, unit).to_string();
        if let Some(effort) = demand.effort {
            let mut words = vec![format!("peak {}", show(effort.peak, demand.effort_unit))];
            if effort.available.is_finite() {
                let of = show(effort.available, demand.effort_unit);
                let _ = write!(words[0], " of {of}, {}", left(effort.peak, effort.available));
            }
            words.push(format!("RMS {}", show(effort.rms, demand.effort_unit)));
            if effort.is_believed {
                words.push("by the drive's estimate of the axis".into());
            }
            screen.line("effort", &words);
        }
        if demand.speed > 0.0 {
            let mut words = vec![show(demand.speed, demand.speed_unit)];
            if demand.speed_unit == "rad/s" {
                let _ = write!(words[0], " ({:.0} rpm)", demand.speed * 60.0 / TAU);
            }
            if let Some(voltage) = demand.voltage {
                words.push(format!("back-EMF {}", show(voltage.back_emf, "V")));
                let degrees = voltage.angle_per_period.to_degrees();
                words.push(format!("{degrees:.1}° electrical per current period"));
            }
            screen.line("motor speed", &words);
        }
        if let Some(voltage) = demand.voltage {
            let [peak, available] = [voltage.peak, voltage.available].map(|volts| show(volts, "V"));
            screen.line("voltage", &[format!("peak {peak} of {available}, {}", left(voltage.peak, voltage.available))]);
        }
    }

    fn cost_line(&self, screen: &mut Screen) {
        let mut words = vec![format!("memory {}", Quantity::new(self.cost.memory, "B"))];
        for (engine, seconds) in &self.cost.seconds {
            words.push(format!("about {:.1} on {engine}", Quantity::new(*seconds, "s")));
        }
        screen.line("cost", &words);
    }
}

/// Lines under each other, names on the left.
#[derive(Default)]
struct Screen {
    text: String,
}

impl Screen {
    /// Parts with commas between them, broken where the line is full; nothing without a part.
    fn line(&mut self, name: &str, parts: &[String]) {
        // A part that is wider than a line is broken between its words.
        let narrow = |part: &str| part.chars().count() < WIDTH - NAMES - 2;
        let pieces: Vec<(String, &str)> = parts
            .iter()
            .enumerate()
            .flat_map(|(i, part)| {
                let comma = if i + 1 < parts.len() { "," } else { "" };
                let words: Vec<&str> = if narrow(part) { vec![part] } else { part.split(' ').collect() };
                let last = words.len() - 1;
                let pieces = words.into_iter().enumerate();
                pieces.map(move |(k, word)| (word.to_owned(), if k == last { comma } else { "" })).collect::<Vec<_>>()
            })
            .collect();
        let mut column = 0;
        for (i, (part, comma)) in pieces.iter().enumerate() {
            let width = part.chars().count() + comma.len();
            let fits = i > 0 && column + 1 + width <= WIDTH;
            if fits {
                self.text.push(' ');
                column += 1 + width;
            } else {
                let name = if i == 0 { name } else { "" };
                let newline = if i == 0 { "" } else { "\n" };
                let _ = write!(self.text, "{newline}  {name:NAMES$}");
                column = 2 + NAMES + width;
            }
            self.text.push_str(part);
            self.text.push_str(comma);
        }
        if !parts.is_empty() {
            self.text.push('\n');
        }
    }
}

/// Share of `available` that is left, in words.
fn left(peak: f64, available: f64) -> String {
    let percent = 100.0 * (1.0 - peak / available);
    if percent < 0.0 { format!("{:.0} % above it", -percent) } else { format!("{percent:.0} % left") }
}

fn share(peak: f64, available: f64) -> String {
    format!("{:.0} %", 100.0 * peak / available)
}

fn inertia(inertias: &Inertias) -> Vec<String> {
    let Inertias { motor, load, turns } = *inertias;
    let unit = if turns { "kg·m²" } else { "kg" };
    let motor_side = format!("motor side {}", Quantity::new(motor, unit));
    if load == 0.0 {
        return vec![motor_side, "rigid".into()];
    }
    vec![
        motor_side,
        format!("load {}", Quantity::new(load, unit)),
        format!("load to motor {}", Quantity::new(load / motor, "")),
    ]
}

fn mode_lines(modes: &Modes, screen: &mut Screen) {
    let words = |modes: &[Mode], how: &str| -> Vec<String> {
        let of = |mode: &Mode| format!("{:.4} (ζ {})", Quantity::new(mode.omega / TAU, "Hz"), damping(mode.damping));
        let mut words: Vec<_> = modes.iter().map(of).collect();
        if let Some(first) = words.first_mut() {
            *first = format!("{how} {first}");
        }
        words
    };
    let mut all = words(&modes.free, "free");
    all.extend(words(&modes.held, "motor held"));
    if all.is_empty() {
        all.push("none: the axis is rigid".into());
    }
    screen.line("modes", &all);
}

/// A damping ratio; a rounding error of the eigenvalues is shown as 0.
fn damping(ratio: f64) -> String {
    if ratio < 1e-9 { "0".into() } else { Quantity::new(ratio, "").to_string() }
}

fn steps(engine: &EngineSteps) -> String {
    let steps =
        format!("{} ticks to a period of {}", rounded(engine.steps), Quantity::new(engine.mode.omega / TAU, "Hz"));
    match (engine.integrator, engine.distortion) {
        (Integrator::Exact, _) => format!("{steps}, no discretisation error"),
        (_, None) => format!("{steps}: unstable"),
        (Integrator::Leapfrog, Some(distortion)) => format!("{steps}, {:.1e} too fast", distortion.shift),
        (Integrator::Rk4, Some(distortion)) => format!("{steps}, adds ζ {:.1e}", distortion.damping),
    }
}

/// To a tenth below a hundred.
fn rounded(steps: f64) -> String {
    if steps < 100.0 { format!("{steps:.1}") } else { format!("{steps:.0}") }
}

fn bandwidth(one: &LoopBandwidth) -> String {
    let rate = Quantity::new(one.rate, "Hz");
    match one.bandwidth {
        Some(bandwidth) => format!("{} {} at {rate}", one.name, Quantity::new(bandwidth / TAU, "Hz")),
        None => format!("{} at {rate}", one.name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preview::preview;
    use std::path::Path;

    fn shown(file: &str) -> String {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(file);
        let loaded = servobench_scenario::load(&path).unwrap_or_else(|error| panic!("{error}"));
        preview(&loaded.scenario, &loaded.scenario.engines, None).unwrap().screen()
    }

    #[test]
    fn every_scenario_fits_a_screen() {
        for file in ["feed-axis-move.toml", "own-mjcf.toml", "vibration-jerk.toml", "plc/buffered.toml", "emps.toml"] {
            let screen = shown(file);
            assert!(screen.lines().count() <= 24 && screen.lines().count() > 3, "{file}:\n{screen}");
            assert!(screen.lines().all(|line| line.chars().count() <= WIDTH), "{file}:\n{screen}");
        }
    }

    #[test]
    fn parts_break_between_commas() {
        let mut screen = Screen::default();
        let part = "x".repeat(40);
        screen.line("loops", &[part.clone(), "y".repeat(23), "z".into()]);
        screen.line("none", &[]);
        let expected = format!("  loops       {part}, {},\n              z\n", "y".repeat(23));
        assert_eq!(screen.text, expected);
    }
}
