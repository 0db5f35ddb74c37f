//! PLCopen XML (TC6): POUs with their interface and a body in Structured Text.
use crate::pou::{Pou, Section, SectionKind, Variable};
use std::fmt::{self, Write as _};

/// Differences between the tools that import the XML.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Flavour {
    pub(crate) namespace: &'static str,
    /// Element of XHTML that holds text, with its attributes.
    pub(crate) text: &'static str,
}

/// TC6 XML 2.01.
pub(crate) const STANDARD: Flavour = Flavour { namespace: "http://www.plcopen.org/xml/tc6_0201", text: "xhtml:p" };
/// TC6 XML 2.0, as CODESYS and TwinCAT write it.
pub(crate) const CODESYS: Flavour =
    Flavour { namespace: "http://www.plcopen.org/xml/tc6_0200", text: "xhtml xmlns=\"http://www.w3.org/1999/xhtml\"" };

/// A project of these POUs; `head` is a comment in front of the first function block, `written` an `xs:dateTime`.
pub(crate) fn text(pous: &[Pou], head: &str, flavour: Flavour, written: &str) -> String {
    let mut xml = Xml { text: String::from("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"), depth: 0, flavour };
    let namespace = flavour.namespace;
    xml.within(&format!("project xmlns=\"{namespace}\" xmlns:xhtml=\"http://www.w3.org/1999/xhtml\""), |xml| {
        let version = env!("CARGO_PKG_VERSION");
        xml.line(format_args!(
            "<fileHeader companyName=\"\" productName=\"servobench\" productVersion=\"{version}\" creationDateTime=\"{written}\"/>"
        ));
        xml.within("contentHeader name=\"Profile4th\"", |xml| {
            xml.within("coordinateInfo", |xml| {
                for language in ["fbd", "ld", "sfc"] {
                    xml.line(format_args!("<{language}><scaling x=\"1\" y=\"1\"/></{language}>"));
                }
            });
        });
        xml.within("types", |xml| {
            xml.line(format_args!("<dataTypes/>"));
            xml.within("pous", |xml| {
                let first = pous.iter().position(|pou| pou.returns.is_none());
                for (k, pou) in pous.iter().enumerate() {
                    xml.pou(pou, if Some(k) == first { head } else { "" });
                }
            });
        });
        xml.within("instances", |xml| xml.line(format_args!("<configurations/>")));
    });
    xml.text
}

/// XML under construction.
struct Xml {
    text: String,
    depth: usize,
    flavour: Flavour,
}

impl Xml {
    fn line(&mut self, line: fmt::Arguments<'_>) {
        let _ = writeln!(self.text, "{:width$}{line}", "", width = 2 * self.depth);
    }

    /// Writes an element with others in it; `tag` is its name with its attributes.
    fn within(&mut self, tag: &str, content: impl FnOnce(&mut Self)) {
        self.line(format_args!("<{tag}>"));
        self.depth += 1;
        content(self);
        self.depth -= 1;
        self.line(format_args!("</{}>", name(tag)));
    }

    /// Writes an element with text in it, as XHTML.
    fn prose(&mut self, tag: &str, text: &str) {
        let holder = self.flavour.text;
        self.line(format_args!("<{tag}><{holder}>{}</{}></{tag}>", escaped(text), name(holder)));
    }

    fn pou(&mut self, pou: &Pou, head: &str) {
        let kind = if pou.returns.is_some() { "function" } else { "functionBlock" };
        self.within(&format!("pou name=\"{}\" pouType=\"{kind}\"", pou.name), |xml| {
            xml.within("interface", |xml| {
                if let Some(returns) = pou.returns {
                    xml.line(format_args!("<returnType><{returns}/></returnType>"));
                }
                for section in &pou.sections {
                    xml.section(section);
                }
            });
            xml.within("body", |xml| xml.prose("ST", &format!("{head}{}", pou.body)));
        });
    }

    fn section(&mut self, section: &Section) {
        let tag = match section.kind {
            SectionKind::Input => "inputVars",
            SectionKind::Output => "outputVars",
            SectionKind::Local => "localVars",
            SectionKind::Temporary => "tempVars",
        };
        self.within(tag, |xml| {
            for variable in &section.variables {
                xml.variable(variable);
            }
        });
    }

    fn variable(&mut self, variable: &Variable) {
        self.within(&format!("variable name=\"{}\"", variable.name), |xml| {
            let type_name = variable.type_name;
            if matches!(type_name, "BOOL" | "SINT" | "INT" | "DINT" | "LINT" | "LREAL") {
                xml.line(format_args!("<type><{type_name}/></type>"));
            } else {
                xml.line(format_args!("<type><derived name=\"{type_name}\"/></type>"));
            }
            if let Some(initial) = variable.initial {
                xml.line(format_args!("<initialValue><simpleValue value=\"{initial}\"/></initialValue>"));
            }
            if !variable.meaning.is_empty() {
                xml.prose("documentation", variable.meaning);
            }
        });
    }
}

/// Name in a tag with attributes.
fn name(tag: &str) -> &str {
    tag.split_once(' ').map_or(tag, |(name, _)| name)
}

/// Escapes `text` between tags.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
