//! YAML that the pages show is a workflow of GitHub Actions as its schema demands: `on` and `jobs` at the top, each job with `runs-on` and
//! `steps`, each step with `uses` or `run`. Source: <https://json.schemastore.org/github-workflow.json>, `required` of each object.
use crate::repository;
use std::fs;

/// A part of a YAML file in block style.
#[derive(Debug, PartialEq)]
enum Node {
    Scalar(String),
    List(Vec<Node>),
    Table(Vec<(String, Node)>),
}

impl Node {
    fn get(&self, key: &str) -> Option<&Self> {
        let Self::Table(pairs) = self else { return None };
        pairs.iter().find(|(own, _)| own == key).map(|(_, value)| value)
    }

    fn keys(&self) -> Vec<&str> {
        let Self::Table(pairs) = self else { return Vec::new() };
        pairs.iter().map(|(key, _)| key.as_str()).collect()
    }
}

/// Reads what these pages need of YAML: tables, lists and scalars by their indentation, texts behind `|`, `[…]` and `{…}` as scalars.
fn read(text: &str) -> Result<Node, String> {
    let lines: Vec<(usize, String)> = text
        .lines()
        .map(|line| line.split(" #").next().unwrap_or_default())
        .filter(|line| !line.trim().is_empty() && !line.trim_start().starts_with('#'))
        .map(|line| (line.len() - line.trim_start().len(), line.trim().to_owned()))
        .collect();
    let mut rest = lines.as_slice();
    let node = block(&mut rest)?;
    rest.first().map_or(Ok(node), |(_, line)| Err(format!("`{line}` is indented like nothing before it")))
}

fn block(lines: &mut &[(usize, String)]) -> Result<Node, String> {
    let Some((indent, first)) = lines.first().cloned() else { return Err("nothing follows".into()) };
    if first.starts_with("- ") {
        let mut items = Vec::new();
        while let Some((own, line)) =
            lines.first().cloned().filter(|(own, line)| *own == indent && line.starts_with("- "))
        {
            // What follows the dash stands two further in.
            let end = 1 + lines[1..].iter().take_while(|(other, _)| *other > own).count();
            let mut item = lines[..end].to_vec();
            item[0] = (own + 2, line[2..].to_owned());
            items.push(block(&mut item.as_slice())?);
            *lines = &lines[end..];
        }
        return Ok(Node::List(items));
    }
    if !first.contains(": ") && !first.ends_with(':') {
        *lines = &lines[1..];
        return Ok(Node::Scalar(first));
    }
    let mut pairs: Vec<(String, Node)> = Vec::new();
    while let Some((_, line)) = lines.first().cloned().filter(|(own, _)| *own == indent) {
        let (key, value) = line.split_once(':').ok_or_else(|| format!("`{line}` has no key"))?;
        *lines = &lines[1..];
        let inner = lines.iter().take_while(|(own, _)| *own > indent).count();
        let value = match value.trim() {
            "" => block(lines)?,
            "|" => {
                let text = lines[..inner].iter().map(|(_, line)| line.as_str()).collect::<Vec<_>>().join("\n");
                *lines = &lines[inner..];
                Node::Scalar(text)
            }
            value => Node::Scalar(value.to_owned()),
        };
        if pairs.iter().any(|(other, _)| other == key) {
            return Err(format!("`{key}` stands twice"));
        }
        pairs.push((key.to_owned(), value));
    }
    Ok(Node::Table(pairs))
}

/// Keys of a workflow, a job and a step.
const WORKFLOW: [&str; 9] =
    ["name", "run-name", "on", "permissions", "env", "defaults", "concurrency", "jobs", "description"];
const JOB: [&str; 9] = ["name", "needs", "runs-on", "if", "env", "strategy", "container", "timeout-minutes", "steps"];
const STEP: [&str; 9] = ["id", "name", "if", "uses", "run", "with", "env", "working-directory", "shell"];

/// What is wrong with a workflow.
fn mistakes(workflow: &Node) -> Vec<String> {
    let mut mistakes = Vec::new();
    let mut unknown = |what: &str, node: &Node, known: &[&str]| {
        mistakes.extend(node.keys().iter().filter(|key| !known.contains(key)).map(|key| format!("{what} has `{key}`")));
    };
    unknown("the workflow", workflow, &WORKFLOW);
    let Some(Node::Table(jobs)) = workflow.get("jobs") else { return vec!["`jobs` is missing".into()] };
    let mut missing = Vec::new();
    if workflow.get("on").is_none() {
        missing.push("`on` is missing".to_owned());
    }
    for (name, job) in jobs {
        unknown(name, job, &JOB);
        if job.get("runs-on").is_none() {
            missing.push(format!("`{name}` has no `runs-on`"));
        }
        let Some(Node::List(steps)) = job.get("steps") else {
            missing.push(format!("`{name}` has no `steps`"));
            continue;
        };
        for step in steps {
            unknown("a step", step, &STEP);
            if step.get("uses").is_some() == step.get("run").is_some() {
                missing.push(format!("a step has one of `uses` and `run`, not {:?}", step.keys()));
            }
        }
    }
    mistakes.extend(missing);
    mistakes
}

/// The fences `yaml` of a page.
fn fences(page: &str) -> impl Iterator<Item = &str> {
    page.split("```yaml\n").skip(1).map(|rest| rest.split("```").next().unwrap_or_default())
}

#[test]
fn each_workflow_of_a_page_is_valid() {
    let docs = fs::read_dir(repository().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let pages = docs.chain([repository().join("README.md")]);
    let mut count = 0;
    for page in pages.filter(|path| path.extension().is_some_and(|extension| extension == "md")) {
        let text = fs::read_to_string(&page).unwrap();
        for yaml in fences(&text) {
            let workflow = read(yaml).unwrap_or_else(|why| panic!("{}: {why}\n{yaml}", page.display()));
            assert_eq!(mistakes(&workflow), Vec::<String>::new(), "{}:\n{yaml}", page.display());
            count += 1;
        }
    }
    assert!(count > 0, "no page has a workflow");
}

/// The job of getting started keeps what failed and nothing else, and hands on both folders.
#[test]
fn the_first_job_keeps_failed_recordings() {
    let page = fs::read_to_string(repository().join("docs/getting-started.md")).unwrap();
    let workflow = read(fences(&page).next().unwrap()).unwrap();
    let steps = workflow.get("jobs").and_then(|jobs| jobs.get("servo")).and_then(|job| job.get("steps"));
    let Some(Node::List(steps)) = steps else { panic!("{workflow:?}") };
    let runs = |step: &Node| matches!(step.get("run"), Some(Node::Scalar(run)) if run.contains("servobench run") && run.contains("--keep failed"));
    assert!(steps.iter().any(runs), "{steps:?}");
    let path = steps.iter().find_map(|step| step.get("with")?.get("path"));
    assert_eq!(path, Some(&Node::Scalar("report\nservobench-out".into())));
}

/// A job without a trigger, without a machine and with a step that does nothing.
#[test]
fn a_workflow_that_github_refuses_is_told() {
    let wrong = "env:\n  A: b\njobs:\n  servo:\n    step:\n      - uses: x\n  other:\n    runs-on: y\n    steps:\n      - name: z\n";
    let found = mistakes(&read(wrong).unwrap());
    for expected in [
        "`on` is missing",
        "servo has `step`",
        "`servo` has no `runs-on`",
        "`servo` has no `steps`",
        "a step has one of",
    ] {
        assert!(found.iter().any(|mistake| mistake.contains(expected)), "{expected}: {found:?}");
    }
    assert!(read("a:\n  b: c\n d: e\n").is_err());
}
