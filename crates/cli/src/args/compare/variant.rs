//! A variant of a scenario: `NAME: KEY=VALUE; KEY=VALUE`.
use servobench_scenario::Override;
use std::str::FromStr;

/// Other values of some keys, under a name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Variant {
    /// Its name.
    pub(crate) name: String,
    /// The keys with their values; empty for the scenario as it is.
    pub(crate) overrides: Vec<Override>,
}

/// What one looks like.
const SHAPE: &str = "write a name and keys with their values, as in 'snap: setpoint.order=4; setpoint.snap=1000m/s4'";
/// Longest name (characters).
const LONGEST: usize = 60;

impl FromStr for Variant {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, rest) = text.split_once(':').ok_or_else(|| format!("there is no name with a colon: {SHAPE}"))?;
        let name = name.trim();
        if name.is_empty() || name.contains('=') {
            return Err(format!("a name is missing before the colon: {SHAPE}"));
        }
        if name.chars().count() > LONGEST {
            return Err(format!("the name has more than {LONGEST} characters"));
        }
        let overrides = parts(rest)?.into_iter().map(|part| {
            let part = part.trim();
            part.parse::<Override>().map_err(|error| format!("{part}: {error}"))
        });
        Ok(Self { name: name.to_owned(), overrides: overrides.collect::<Result<_, _>>()? })
    }
}

/// `text` at every `;` that is in no string, list or table of TOML; what has nothing in it is left out.
fn parts(text: &str) -> Result<Vec<&str>, String> {
    let mut parts = Vec::new();
    let mut rest = text;
    while !rest.trim().is_empty() {
        let end = end(rest)?;
        let (part, behind) = rest.split_at(end);
        if !part.trim().is_empty() {
            parts.push(part);
        }
        rest = behind.strip_prefix(';').unwrap_or(behind);
    }
    Ok(parts)
}

/// Where the first part of `text` ends. A quote in a value that begins otherwise is a character like any other (`5'`), as it is for
/// an override.
fn end(text: &str) -> Result<usize, String> {
    let mut scan = Scan { depth: 0, quote: None, is_escaped: false };
    let mut is_toml = None;
    let mut is_in_key = true;
    for (at, c) in text.char_indices() {
        if is_in_key {
            match c {
                '=' if scan.is_outside() => is_in_key = false,
                ';' if scan.is_outside() => return Ok(at),
                _ => scan.take(c),
            }
            continue;
        }
        if is_toml.is_none() && !c.is_whitespace() {
            is_toml = Some(matches!(c, '[' | '{' | '"' | '\''));
        }
        if c == ';' && scan.is_outside() {
            return Ok(at);
        }
        if is_toml == Some(true) {
            scan.take(c);
        }
    }
    if scan.is_outside() {
        return Ok(text.len());
    }
    Err(match scan.quote {
        Some(quote) => format!("the quote {quote} is not closed in: {}", text.trim()),
        None => format!("a bracket is not closed in: {}", text.trim()),
    })
}

/// How deep in brackets and quotes a text is.
struct Scan {
    depth: u32,
    quote: Option<char>,
    is_escaped: bool,
}

impl Scan {
    const fn is_outside(&self) -> bool {
        self.depth == 0 && self.quote.is_none()
    }

    fn take(&mut self, c: char) {
        match (self.quote, c) {
            _ if self.is_escaped => self.is_escaped = false,
            (Some('"'), '\\') => self.is_escaped = true,
            (Some(quote), c) if c == quote => self.quote = None,
            (None, '"' | '\'') => self.quote = Some(c),
            (None, '[' | '{') => self.depth += 1,
            (None, ']' | '}') => self.depth = self.depth.saturating_sub(1),
            (None | Some(_), _) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn overrides(text: &str) -> Result<Vec<String>, String> {
        let variant: Variant = text.parse()?;
        Ok(variant.overrides.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn keys_are_parted_where_no_value_goes_on() {
        for (text, expected) in [
            ("as it is:", vec![]),
            ("a: ;  ;", vec![]),
            ("snap: setpoint.order=4; setpoint.snap=1000m/s4", vec!["setpoint.order=4", "setpoint.snap=1000m/s4"]),
            (
                "two: setpoint.shaper=[{ kind = \"zv\", frequency = \"17.5 Hz\" }, { kind = 'ei', frequency = '31 Hz' }]; run.duration=2s",
                vec![
                    "setpoint.shaper=[{ kind = \"zv\", frequency = \"17.5 Hz\" }, { kind = 'ei', frequency = '31 Hz' }]",
                    "run.duration=2s",
                ],
            ),
            (r#"q: description="a; \"b; c: d\\"; name='x;y'"#, vec![r#"description="a; \"b; c: d\\""#, "name='x;y'"]),
            ("p: fmu[0].parameters.'a;b=c'=1; name=it's", vec!["fmu[0].parameters.'a;b=c'=1", "name=it's"]),
            ("t: description=12:30, at noon; run.duration=1s", vec!["description=12:30, at noon", "run.duration=1s"]),
        ] {
            let expected: Vec<String> = expected.into_iter().map(str::to_owned).collect();
            assert_eq!(overrides(text), Ok(expected), "{text}");
        }
        assert_eq!("as it is:".parse::<Variant>().unwrap().name, "as it is");
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (text, part) in [
            ("setpoint.order=3", "there is no name with a colon"),
            (": setpoint.order=3", "a name is missing"),
            ("setpoint.shaper={kind: 1}", "a name is missing"),
            ("a: setpoint.order", "missing `=`"),
            ("a: setpoint.shaper=[1; 2", "a bracket is not closed"),
            ("a: description=\"x; name=y", "the quote \" is not closed"),
            ("a: name=[1]]; b=2", "the value begins like TOML"),
        ] {
            let error = overrides(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
