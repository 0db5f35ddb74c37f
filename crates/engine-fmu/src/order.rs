//! The request to load that the process of an FMU receives.
use serde::{Deserialize, Serialize};
use servobench_fmi::{FmuError, Loaded, Setup, Slave, Unpacked};
use std::path::PathBuf;

/// A setup and the location of the FMU.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Order {
    /// The file, for messages.
    path: PathBuf,
    /// Its unpacked content.
    folder: PathBuf,
    setup: Setup,
}

impl Order {
    pub(crate) fn new(fmu: &Unpacked, setup: &Setup) -> Self {
        Self { path: fmu.path().to_owned(), folder: fmu.folder().to_owned(), setup: setup.clone() }
    }

    /// Loads and initialises the FMU in this process.
    pub(crate) fn load(self) -> Result<Box<dyn Slave>, FmuError> {
        let fmu = Unpacked::in_folder(&self.path, &self.folder)?;
        Ok(Box::new(Loaded::new(&fmu, &self.setup)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_fmi::{Port, Value};

    #[test]
    fn a_setup_arrives_as_it_was_sent() {
        let port = |name: &str, element| Port { variable: name.into(), element };
        let list = vec![Value::Number(0.1 + 0.2), Value::List(vec![Value::Boolean(true)])];
        let setup = Setup {
            instance_name: "µ \"table\"\n".into(),
            start_values: vec![
                ("gain".into(), Value::Number(-0.0)),
                ("far".into(), Value::Number(f64::INFINITY)),
                ("count".into(), Value::Integer(i128::from(u64::MAX))),
                ("name".into(), Value::Text("\u{1f600}".into())),
                ("bytes".into(), Value::Binary(vec![0, 255])),
                ("matrix".into(), Value::List(list)),
                ("mass".into(), Value::Quantity { text: "0.1 t".into(), si: 100.1, exponents: [1, 0, 0, 0] }),
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
        let order = Order { path: "a.fmu".into(), folder: "/tmp/a".into(), setup };
        let sent = serde_json::to_string(&order).unwrap();
        let arrived: Order = serde_json::from_str(&sent).unwrap();
        assert_eq!(arrived, order);
        let Value::Number(gain) = arrived.setup.start_values[0].1 else { panic!("a number") };
        assert!(gain.is_sign_negative());
    }
}
