//! Tables of a scenario file, each described once: the description yields the struct, its decoding, the check for unknown keys, the
//! JSON Schema and the reference in `docs/scenario.md`.
use crate::diagnostic::{MOST_MISTAKES, Report};
use crate::field::{Field, Slot};

use crate::source::{At, Span};
use crate::tree::{Node, Table, Value};
use serde_json::{Map, Value as Json, json};
use servobench_files::suggestion;

/// Describes a table.
///
/// ```text
/// table! {
///     /// Meaning of the table.
///     pub(crate) struct Name requires ["key"] {
///         /// Meaning of the key; for a parameter described by its owner: an addition to that meaning.
///         key: Type = specification,
///         /// A key that is not a Rust identifier.
///         field as "static": Type = specification,
///         ..field: Keys = specification
///     }
/// }
/// ```
/// Each key becomes a field `Slot<Type>`; the struct also has the `span` of its header. The keys of the group after `..` are listed
/// elsewhere.
///
/// A table whose keys depend on its place, such as an encoder's on its body, is `struct Name of (place: Place)`, and its
/// specifications can use `place`.
///
/// A table may set the parameters of another crate: `struct Name sets Parameters`. With `key: Type = specification => field` the key sets
/// that field of the `parameters`; without the key, the field has its default.
macro_rules! table {
    (
        $(#[doc = $table_doc:literal])+
        pub(crate) struct $table:ident $(of ($place:ident: $place_type:ty))? sets $parameters:ty {
            $(
                $(#[doc = $doc:literal])*
                $field:ident: $type:ty = $spec:expr $(=> $set:ident $(.$inner:ident)? $([$index:literal])?)?,
            )+
            $(..$group:ident: $group_type:ty = $group_spec:expr)?
        }
    ) => {
        $crate::table::table! {
            $(#[doc = $table_doc])+
            pub(crate) struct $table $(of ($place: $place_type))? {
                $($(#[doc = $doc])* $field: $type = $spec,)+
                $(..$group: $group_type = $group_spec)?
            }
        }

        impl $table {
            /// The parameters set by the keys, with the default in place of wrong values, and an error if any was wrong.
            pub(crate) fn parameters(&self) -> ($parameters, Result<(), $crate::field::Reported>) {
                let (mut parameters, mut are_right) = (<$parameters>::default(), Ok(()));
                $($(
                    match self.$field.optional() {
                        Ok(Some(value)) => parameters.$set$(.$inner)?$([$index])? = *value,
                        Ok(None) => {}
                        Err(reported) => are_right = Err(reported),
                    }
                )?)+
                (parameters, are_right)
            }
        }

        impl $crate::table::Keys for $table {
            fn spans(&self) -> Vec<(&'static str, Option<$crate::source::Span>)> {
                vec![$((stringify!($field), self.$field.span()),)+]
            }
        }
    };
    (
        $(#[doc = $table_doc:literal])+
        pub(crate) struct $table:ident $(of ($place:ident: $place_type:ty))? $(requires [$($required:literal),+])? {
            $(
                $(#[doc = $doc:literal])*
                $field:ident $(as $name:literal)? : $type:ty = $spec:expr,
            )+
            $(..$group:ident: $group_type:ty = $group_spec:expr)?
        }
    ) => {
        $(#[doc = $table_doc])+
        #[derive(Debug, Clone, PartialEq)]
        pub(crate) struct $table {
            /// Header of the table.
            pub(crate) span: $crate::source::Span,
            $(
                $(#[doc = $doc])*
                pub(crate) $field: $crate::field::Slot<$type>,
            )+
            $(
                /// Keys that are listed elsewhere.
                pub(crate) $group: $group_type,
            )?
        }

        impl $crate::field::Field<$crate::table::or_unit!($($place_type)?)> for $table {
            fn decode(
                path: &str,
                node: &$crate::tree::Node,
                &$crate::table::or_unit!($($place)?): &$crate::table::or_unit!($($place_type)?),
                report: &mut $crate::diagnostic::Report,
            ) -> Option<Self> {
                let keys = [$($crate::table::key_name!($field $(as $name)?),)+];
                $(let keys: Vec<&str> = keys.into_iter().chain(<$group_type>::keys($group_spec)).collect();)?
                let required: &[&str] = &[$($($required),+)?];
                let mut open = $crate::table::OpenTable::new(path, node, &keys, required, report)?;
                Some(Self {
                    span: node.span,
                    $($field: open.field($crate::table::key_name!($field $(as $name)?), &$spec),)+
                    $($group: <$group_type>::read(&mut open, $group_spec),)?
                })
            }

            fn schema(&$crate::table::or_unit!($($place)?): &$crate::table::or_unit!($($place_type)?)) -> serde_json::Value {
                let required: &[&str] = &[$($($required),+)?];
                let keys = [$((
                    $crate::table::key_name!($field $(as $name)?),
                    (<$type as $crate::field::Field<_>>::meaning(&$spec), &[$($doc,)*] as &[&str]),
                    <$type as $crate::field::Field<_>>::schema(&$spec),
                ),)+];
                $(
                    let group = <$group_type>::schemas($group_spec);
                    let group = group.iter().map(|(key, (meaning, doc), schema)| (*key, (*meaning, doc.as_slice()), schema.clone()));
                    let keys = keys.into_iter().chain(group);
                )?
                $crate::table::object_schema(&[$($table_doc,)+], required, keys.into_iter().collect())
            }
        }
    };
}

/// Name of a field in files.
macro_rules! key_name {
    ($field:ident) => {
        stringify!($field)
    };
    ($field:ident as $name:literal) => {
        $name
    };
}

/// The given type or pattern, or the unit.
macro_rules! or_unit {
    () => {
        ()
    };
    ($given:tt) => {
        $given
    };
}

pub(crate) use key_name;
pub(crate) use or_unit;
pub(crate) use table;

/// A table whose keys can be listed.
pub(crate) trait Keys {
    /// Its keys, except those of groups, and their places.
    fn spans(&self) -> Vec<(&'static str, Option<Span>)>;
}

/// A table that is being read.
pub(crate) struct OpenTable<'a> {
    path: &'a str,
    table: &'a Table,
    report: &'a mut Report,
}

impl<'a> OpenTable<'a> {
    /// Opens the table `node`; reports every key that is not in `keys` and every missing key of `required`.
    pub(crate) fn new(
        path: &'a str,
        node: &'a Node,
        keys: &[&str],
        required: &[&str],
        report: &'a mut Report,
    ) -> Option<Self> {
        let Value::Table(table) = &node.value else {
            let message = format!("`{path}` must be a table, got {}", node.value.kind());
            report.error(node.span, message, format!("write `[{path}]`"));
            return None;
        };
        for entry in &table.entries {
            if !keys.contains(&entry.key.as_str()) {
                let message = format!("unknown key `{}`{}", entry.key, of(path));
                // With so many unknown keys, suggestions are of no use.
                let is_shown = report.errors.len() < 10 * MOST_MISTAKES;
                let help = if is_shown { suggestion(&entry.key, keys.iter().copied()) } else { String::new() };
                report.error(entry.key_span, message, help);
            }
        }
        for key in required {
            if table.get(key).is_none() {
                report.missing(path, key, node.span);
            }
        }
        Some(Self { path, table, report })
    }

    /// Reads one key.
    pub(crate) fn field<Spec, T: Field<Spec>>(&mut self, key: &str, spec: &Spec) -> Slot<T> {
        let Some(node) = self.table.get(key) else { return Slot::Absent };
        let path = if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) };
        match T::decode(&path, node, spec, self.report) {
            Some(value) => Slot::Given(At { value, span: node.span }),
            None => Slot::Wrong(node.span),
        }
    }
}

fn of(path: &str) -> String {
    if path.is_empty() { String::new() } else { format!(" in `{path}`") }
}

impl Report {
    /// Reports that the table `path`, whose header is at `span`, lacks `key`.
    pub(crate) fn missing(&mut self, path: &str, key: &str, span: Span) {
        self.missing_with_help(path, key, span, "");
    }

    /// Like [`Self::missing`], with a help.
    pub(crate) fn missing_with_help(&mut self, path: &str, key: &str, span: Span, help: &str) {
        let message = match path {
            "" => format!("missing table `[{key}]`"),
            _ => format!("missing `{key}` in `{path}`"),
        };
        self.lacking(path, span, message, help);
    }
}

/// Joins the lines of a doc comment.
fn joined(doc: &[&str]) -> String {
    doc.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ")
}

/// The meaning of a parameter according to its owner, followed by the key's addition: a default, or another clause.
fn of_key((meaning, key): (&str, &[&str])) -> String {
    let key = joined(key);
    match (meaning, key.as_str()) {
        ("", _) => key,
        (_, "") => format!("{meaning}."),
        (_, _) if key.starts_with("default: ") => format!("{meaning}; {key}"),
        (_, _) if key.starts_with(':') => format!("{meaning}{key}"),
        (_, _) => format!("{meaning} {key}"),
    }
}

/// Documentation of a key: the meaning according to the owner of its parameter, and the lines of the key.
pub(crate) type KeyDoc<'a> = (&'a str, &'a [&'a str]);

/// A key of a group: its name, its documentation as in [`KeyDoc`], and its schema.
pub(crate) type GroupKey<const LINES: usize> = (&'static str, (&'static str, [&'static str; LINES]), Json);

pub(crate) fn object_schema(doc: &[&str], required: &[&str], keys: Vec<(&'static str, KeyDoc<'_>, Json)>) -> Json {
    let mut properties = Map::new();
    // A JSON object has no order: `x-order` keeps that of the description for the documentation.
    let order: Vec<&str> = keys.iter().map(|(name, ..)| *name).collect();
    for (name, doc, mut schema) in keys {
        schema["description"] = Json::String(of_key(doc));
        properties.insert(name.to_owned(), schema);
    }
    let mut schema = json!({
        "type": "object",
        "description": joined(doc),
        "additionalProperties": false,
        "properties": properties,
        "x-order": order,
    });
    if !required.is_empty() {
        schema["required"] = json!(required);
    }
    schema
}
