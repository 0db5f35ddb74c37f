//! Simulates an FMU in this process, for comparison with other programs: a request as JSON on standard input, the answer as JSON on
//! standard output.
//!
//! ```json
//! { "fmu": "a.fmu", "start": { "gain": 2, "mode": "torque" }, "inputs": ["u", ["v", 1]], "outputs": ["y"],
//!   "start_time": 0, "step": 0.01, "steps": 100, "values": [[[1, 0, 0], [0, 0, 0]]], "rewind": [10, 5] }
//! ```
//! `inputs` and `outputs` are names, of arrays with the element; `values` has a row for each step, with value and two derivatives of each
//! input, and the last row is repeated. `rewind` saves the state before a step, takes some steps more, and goes back: the rows are those
//! of an FMU that never did.
use serde::Deserialize;
use serde_json::json;
use servobench_fmi::{Choice, Loaded, ModelDescription, Port, Setup, Slave, StepEnd, Unpacked, Value};
use std::collections::BTreeMap;
use std::error::Error;
use std::io::Write;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Request {
    fmu: String,
    #[serde(default)]
    start: BTreeMap<String, serde_json::Value>,
    #[serde(default)]
    inputs: Vec<Name>,
    #[serde(default)]
    outputs: Vec<Name>,
    #[serde(default)]
    start_time: f64,
    tolerance: Option<f64>,
    step: f64,
    steps: usize,
    #[serde(default)]
    values: Vec<Vec<[f64; 3]>>,
    rewind: Option<[usize; 2]>,
}

#[derive(Deserialize, Clone)]
#[serde(untagged)]
enum Name {
    Scalar(String),
    Element(String, usize),
}

impl From<Name> for Port {
    fn from(name: Name) -> Self {
        match name {
            Name::Scalar(variable) => Self { variable, element: 0 },
            Name::Element(variable, element) => Self { variable, element },
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("{}", answer()?);
    std::io::stdout().flush()?;
    leave();
}

/// Ends the process without the exit handlers of libraries: that of PythonFMU3 0.3.4 uses freed memory.
#[expect(unsafe_code, reason = "the call is one of C")]
fn leave() -> ! {
    // SAFETY: everything is written, and nothing is left to do.
    unsafe { libc::_exit(0) }
}

fn answer() -> Result<serde_json::Value, Box<dyn Error>> {
    let request: Request = serde_json::from_reader(std::io::stdin())?;
    let unpacked = Unpacked::new(&request.fmu)?;
    let start = request.start.iter().map(|(name, value)| Ok((name.clone(), start_value(value)?)));
    let setup = Setup {
        instance_name: "simulated".into(),
        start_values: start.collect::<Result<_, Box<dyn Error>>>()?,
        inputs: request.inputs.iter().cloned().map(Port::from).collect(),
        outputs: request.outputs.iter().cloned().map(Port::from).collect(),
        start_time: request.start_time,
        stop_time: None,
        tolerance: request.tolerance,
        logging: false,
        ..Setup::default()
    };
    let mut slave = Loaded::new(&unpacked, &setup)?;
    let mut run = Run { request: &request, rows: vec![], outputs: vec![0.0; setup.outputs.len()] };
    run.read(&mut slave, request.start_time)?;
    let mut at = 0;
    while at < request.steps {
        if let Some([from, count]) = request.rewind
            && at == from
        {
            slave.save()?;
            let rows = run.rows.clone();
            for ahead in 0..count {
                run.step(&mut slave, at + ahead)?;
            }
            slave.restore()?;
            run.rows = rows;
        }
        if !run.step(&mut slave, at)? {
            break;
        }
        at += 1;
    }
    let log: Vec<_> = slave
        .take_log()
        .into_iter()
        .map(|line| json!([format!("{:?}", line.severity), line.category, line.message]))
        .collect();
    Ok(json!({ "rows": run.rows, "log": log, "variables": variables(unpacked.description()) }))
}

/// The description's facts on each variable.
fn variables(it: &ModelDescription) -> Vec<serde_json::Value> {
    let variable = |variable: &servobench_fmi::Variable| {
        json!({
            "name": variable.name,
            "reference": variable.value_reference,
            "type": variable.data_type.name(),
            "causality": variable.causality.name(),
            "variability": variable.variability.name(),
            "initial": variable.initial.map(Choice::name),
            "shape": it.shape(variable),
            "unit": it.unit(variable).map(|unit| &unit.name),
            "min": variable.min,
            "max": variable.max,
            "derivative_of": variable.derivative_of.map(|of| &it.variables[of].name),
        })
    };
    it.variables.iter().map(variable).collect()
}

fn start_value(value: &serde_json::Value) -> Result<Value, Box<dyn Error>> {
    Ok(match value {
        serde_json::Value::Number(number) => match number.as_i64() {
            Some(integer) => Value::Integer(integer.into()),
            None => Value::Number(number.as_f64().ok_or("a number that is no f64")?),
        },
        serde_json::Value::Bool(is) => Value::Boolean(*is),
        serde_json::Value::String(text) => Value::Text(text.clone()),
        serde_json::Value::Array(values) => Value::List(values.iter().map(start_value).collect::<Result<_, _>>()?),
        other => return Err(format!("{other} starts nothing").into()),
    })
}

struct Run<'a> {
    request: &'a Request,
    /// Time and outputs.
    rows: Vec<Vec<f64>>,
    outputs: Vec<f64>,
}

impl Run<'_> {
    /// One communication step, in parts if the FMU returns early. Returns true if the simulation continues.
    fn step(&mut self, slave: &mut Loaded, at: usize) -> Result<bool, Box<dyn Error>> {
        let request = self.request;
        let time = |at: usize| request.start_time + at as f64 * request.step;
        let (mut now, end) = (time(at), time(at + 1));
        let row = request.values.get(at).or(request.values.last());
        let inputs = row.map_or(&[][..], |row| &row[..]);
        loop {
            match slave.step(now, end - now, inputs)? {
                StepEnd::Done => {
                    self.read(slave, end)?;
                    return Ok(true);
                }
                StepEnd::Until(reached) if reached > now => {
                    now = reached;
                    self.read(slave, reached)?;
                }
                StepEnd::Until(reached) => return Err(format!("no progress at {reached} s").into()),
                StepEnd::Terminated(reached) => {
                    self.read(slave, reached)?;
                    return Ok(false);
                }
            }
        }
    }

    fn read(&mut self, slave: &mut Loaded, time: f64) -> Result<(), Box<dyn Error>> {
        slave.read(None, &mut self.outputs)?;
        self.rows.push([&[time], &self.outputs[..]].concat());
        Ok(())
    }
}
