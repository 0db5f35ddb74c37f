//! Runs the generator block for the requests on standard input, one a line, and prints a line for each, so that a program in another
//! language can compare its block with this one, sample by sample.
//!
//! ```text
//! ORDER  TS T_SET  VELOCITY ACCELERATION JERK SNAP  REVERSED  START TARGET ...
//! ```
//!
//! Numbers are SI, REVERSED is 0 or 1. The block is set back, then moves to each target in turn: enabled for one sample, then
//! stepped until done or in error. The answer is the number of samples and the 64-bit FNV-1a sum of the bits of all outputs of all
//! samples. With the argument `trace` it is all outputs instead, a sample a line.
use servobench_motion::{Limits, Order};
use servobench_plcopen::generator::{Input, Method, Mounting, Output, Params, State, step};
use std::error::Error;
use std::io::{self, BufWriter, Write};

/// Highest number of samples of a move: more is a mistake in the request.
const MOST: u64 = 10_000_000;

fn main() -> Result<(), Box<dyn Error>> {
    let is_traced = std::env::args().nth(1).is_some_and(|argument| argument == "trace");
    let mut out = BufWriter::new(io::stdout().lock());
    for (number, line) in io::stdin().lines().enumerate() {
        let line = line?;
        let answer = answer(&line, is_traced.then_some(&mut out as &mut dyn Write));
        let (samples, sum) = answer.map_err(|error| format!("line {}, `{line}`: {error}", number + 1))?;
        if !is_traced {
            writeln!(out, "{samples} {sum:016x}")?;
        }
    }
    Ok(out.flush()?)
}

fn answer(line: &str, mut trace: Option<&mut dyn Write>) -> Result<(u64, u64), Box<dyn Error>> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let [order, numbers @ ..] = words.as_slice() else { return Err("a request begins with the order".into()) };
    let order = Order::from_derivative(order.parse()?).ok_or("the order is 2, 3 or 4")?;
    let numbers = numbers.iter().map(|word| word.parse()).collect::<Result<Vec<f64>, _>>()?;
    let [sample_time, settling_time, velocity, acceleration, jerk, snap, reversed, start, targets @ ..] =
        numbers.as_slice()
    else {
        return Err("a request has nine numbers at least".into());
    };
    let params = Params::new(*sample_time, *settling_time)?;
    let mounting = if *reversed == 0.0 { Mounting::Same } else { Mounting::Opposite };
    let limits = Limits { velocity: *velocity, acceleration: *acceleration, jerk: *jerk, snap: *snap };
    let mut input = Input {
        method: Method::Initialize,
        order,
        reference: 0.0,
        limits,
        enable: false,
        actual_reference: *start,
        mounting,
    };
    let mut state = State::default();
    let (mut samples, mut sum) = (0, 0xcbf2_9ce4_8422_2325_u64);
    let mut call = |state: &mut State, input: &Input| -> Result<Output, io::Error> {
        let output = step(&params, state, input);
        for word in words_of(&output) {
            sum = (sum ^ word).wrapping_mul(0x0000_0100_0000_01b3);
        }
        samples += 1;
        if let Some(trace) = &mut trace {
            let set_point = &output.set_point;
            let [x, v, a, j, s] = [set_point.x, set_point.v, set_point.a, set_point.j, set_point.s];
            let (added, flags) = (output.added, words_of(&output)[6]);
            writeln!(trace, "{x:e} {v:e} {a:e} {j:e} {s:e} {added:e} {flags}")?;
        }
        Ok(output)
    };
    let mut last = call(&mut state, &input)?;
    input.method = Method::Step;
    for target in targets {
        (input.reference, input.actual_reference, input.enable) = (*target, last.set_point.x, true);
        last = call(&mut state, &input)?;
        input.enable = false;
        let mut count = 0;
        // The sample after the edge plans: only from there on Done and Error are those of this move.
        while count == 0 || !(last.done || last.error.is_some()) {
            last = call(&mut state, &input)?;
            count += 1;
            if count > MOST {
                return Err("the move does not end".into());
            }
        }
    }
    Ok((samples, sum))
}

/// The bits of each output; of the flags CmdDone is 1, Ready 2, Error 4.
fn words_of(output: &Output) -> [u64; 7] {
    let set_point = &output.set_point;
    let flags = u64::from(output.done) | u64::from(output.ready) << 1 | u64::from(output.error.is_some()) << 2;
    let numbers = [set_point.x, set_point.v, set_point.a, set_point.j, set_point.s, output.added].map(f64::to_bits);
    let [x, v, a, j, s, added] = numbers;
    [x, v, a, j, s, added, flags]
}
