//! What the process of an FMU is told to load.
use serde::{Deserialize, Serialize};
use servobench_fmi::{FmuError, Loaded, Port, Setup, Slave, Unpacked, Value};
use std::path::PathBuf;

/// A setup, and where the FMU is. Floating-point numbers go as their bits: what is loaded there is what would be here.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Order {
    /// The file, for messages.
    path: PathBuf,
    /// What was in it.
    folder: PathBuf,
    instance_name: String,
    start_values: Vec<(String, OrderValue)>,
    inputs: Vec<(String, usize)>,
    outputs: Vec<(String, usize)>,
    start_time: u64,
    stop_time: Option<u64>,
    tolerance: Option<u64>,
    logging: bool,
    waits: bool,
    without_event_mode: bool,
}

/// A [`Value`] on its way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum OrderValue {
    Number(u64),
    Integer(String),
    Boolean(bool),
    Text(String),
    Binary(Vec<u8>),
    List(Vec<OrderValue>),
}

impl Order {
    pub(crate) fn new(fmu: &Unpacked, setup: &Setup) -> Self {
        let ports = |ports: &[Port]| ports.iter().map(|port| (port.variable.clone(), port.element)).collect();
        Self {
            path: fmu.path().to_owned(),
            folder: fmu.folder().to_owned(),
            instance_name: setup.instance_name.clone(),
            start_values: setup.start_values.iter().map(|(name, value)| (name.clone(), value.into())).collect(),
            inputs: ports(&setup.inputs),
            outputs: ports(&setup.outputs),
            start_time: setup.start_time.to_bits(),
            stop_time: setup.stop_time.map(f64::to_bits),
            tolerance: setup.tolerance.map(f64::to_bits),
            logging: setup.logging,
            waits: setup.waits,
            without_event_mode: setup.without_event_mode,
        }
    }

    fn setup(self) -> Setup {
        let ports = |ports: Vec<(String, usize)>| {
            ports.into_iter().map(|(variable, element)| Port { variable, element }).collect()
        };
        Setup {
            instance_name: self.instance_name,
            start_values: self.start_values.into_iter().map(|(name, value)| (name, value.into())).collect(),
            inputs: ports(self.inputs),
            outputs: ports(self.outputs),
            start_time: f64::from_bits(self.start_time),
            stop_time: self.stop_time.map(f64::from_bits),
            tolerance: self.tolerance.map(f64::from_bits),
            logging: self.logging,
            waits: self.waits,
            without_event_mode: self.without_event_mode,
        }
    }

    /// Loads and initialises the FMU in this process.
    pub(crate) fn load(self) -> Result<Box<dyn Slave>, FmuError> {
        let fmu = Unpacked::in_folder(&self.path, &self.folder)?;
        Ok(Box::new(Loaded::new(&fmu, &self.setup())?))
    }
}

impl From<&Value> for OrderValue {
    fn from(value: &Value) -> Self {
        match value {
            Value::Number(number) => Self::Number(number.to_bits()),
            Value::Integer(number) => Self::Integer(number.to_string()),
            Value::Boolean(is) => Self::Boolean(*is),
            Value::Text(text) => Self::Text(text.clone()),
            Value::Binary(bytes) => Self::Binary(bytes.clone()),
            Value::List(values) => Self::List(values.iter().map(Into::into).collect()),
        }
    }
}

impl From<OrderValue> for Value {
    fn from(value: OrderValue) -> Self {
        match value {
            OrderValue::Number(bits) => Self::Number(f64::from_bits(bits)),
            // It was one when it was written; no number is what nothing takes.
            OrderValue::Integer(digits) => digits.parse().map_or(Self::Number(f64::NAN), Self::Integer),
            OrderValue::Boolean(is) => Self::Boolean(is),
            OrderValue::Text(text) => Self::Text(text),
            OrderValue::Binary(bytes) => Self::Binary(bytes),
            OrderValue::List(values) => Self::List(values.into_iter().map(Into::into).collect()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setup_arrives_as_it_was_sent() {
        let port = |name: &str, element| Port { variable: name.into(), element };
        let list = vec![Value::Number(0.1 + 0.2), Value::List(vec![Value::Boolean(true)])];
        let setup = Setup {
            instance_name: "µ \"table\"\n".into(),
            start_values: vec![
                ("gain".into(), Value::Number(-0.0)),
                ("count".into(), Value::Integer(i128::from(u64::MAX))),
                ("name".into(), Value::Text("\u{1f600}".into())),
                ("bytes".into(), Value::Binary(vec![0, 255])),
                ("matrix".into(), Value::List(list)),
            ],
            inputs: vec![port("u", 0), port("u", 3)],
            outputs: vec![port("y", 1)],
            start_time: 1e-300,
            stop_time: Some(f64::MAX),
            tolerance: Some(1e-7),
            logging: true,
            waits: true,
            without_event_mode: true,
        };
        let order = Order {
            path: "a.fmu".into(),
            folder: "/tmp/a".into(),
            instance_name: setup.instance_name.clone(),
            start_values: setup.start_values.iter().map(|(name, value)| (name.clone(), value.into())).collect(),
            inputs: vec![("u".into(), 0), ("u".into(), 3)],
            outputs: vec![("y".into(), 1)],
            start_time: setup.start_time.to_bits(),
            stop_time: setup.stop_time.map(f64::to_bits),
            tolerance: setup.tolerance.map(f64::to_bits),
            logging: true,
            waits: true,
            without_event_mode: true,
        };
        let sent = serde_json::to_string(&order).unwrap();
        let arrived: Order = serde_json::from_str(&sent).unwrap();
        assert_eq!(arrived, order);
        assert_eq!(arrived.setup(), setup);
    }
}
