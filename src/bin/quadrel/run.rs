//! Meshing one domain: read, generate, write, report.

use crate::arguments::MeshArguments;
use crate::{progress, report, Outcome};
use quadrel::error::{Error, Result};
use quadrel::input::{self, Expression, Model};
use quadrel::mesh::HighOrderMesh;
use quadrel::options::{SizeFunction, Tolerance};
use quadrel::output::{self, svg, Format};
use quadrel::stages::Stages;
use quadrel::statistics::Statistics;
use quadrel::Options;
use std::io::Write;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Order and tolerance of the embedded domain: those of the paper's figure.
const EMBEDDED_ORDER: usize = 5;
const EMBEDDED_TOLERANCE: f64 = 1e-2;

/// Why a run did not end with a mesh: by the fault of the domain, or of the arguments and files.
struct Failure {
    error: Error,
    outcome: Outcome,
}

/// Errors of arguments and files are told from those of domains.
impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let outcome = match error {
            Error::InvalidArgument { .. }
            | Error::Io { .. }
            | Error::Unsupported { .. }
            | Error::Parse { .. } => Outcome::Unusable,
            _ => Outcome::Refused,
        };
        Failure { error, outcome }
    }
}

/// Runs the command and says what happened.
pub fn run(arguments: &MeshArguments) -> Outcome {
    let started = Instant::now();
    let mut stages = Stages::default();
    let shown = arguments.domain.as_ref().map_or("gingerbread man".into(), |d| d.display().to_string());
    let work = AssertUnwindSafe(|| make(arguments, &mut stages));
    let made = catch_unwind(work)
        .unwrap_or_else(|_| Err(Error::Internal { reason: "a panic (its message is above)".into() }.into()));
    progress::clear();
    let total = started.elapsed().as_secs_f64();
    let (outcome, text) = finish(arguments, &stages, made, total, &shown);
    // A reader that has gone away is no reason to fail.
    let _ = std::io::stdout().write_all(text.as_bytes());
    outcome
}

/// A finished mesh and the files it is to be written to.
struct Made {
    mesh: HighOrderMesh,
    files: Vec<(PathBuf, Format)>,
    title: String,
}

/// Reads and meshes the domain. Everything about the arguments is checked before.
fn make(arguments: &MeshArguments, stages: &mut Stages) -> std::result::Result<Made, Failure> {
    let files = output_files(arguments)?;
    for path in files.iter().map(|(path, _)| path).chain(&arguments.stats) {
        check_writable(path, arguments.domain.as_deref())?;
    }
    let mut options = options(arguments)?;
    options.check()?;
    let model = match &arguments.domain {
        Some(path) => input::read(path, arguments.component),
        None => input::gingerbread_man(),
    }?;
    complete(&mut options, arguments, &model)?;
    for (_, format) in &files {
        format.check_order(options.order)?;
    }
    let title = report::title(&model.name, &options);
    let result = quadrel::generate(&model.domain, &options, stages);
    stages.put_first(&model.warnings);
    if model.size.is_some() && !arguments.refinement_regions {
        let what = "the file's refinement regions are left out; --refinement-regions applies their sizes";
        stages.put_first(&[what.into()]);
    }
    Ok(Made { mesh: result?, files, title })
}

/// Writes what is to be written and words the report.
fn finish(
    arguments: &MeshArguments,
    stages: &Stages,
    made: std::result::Result<Made, Failure>,
    total: f64,
    shown: &str,
) -> (Outcome, String) {
    let (mut outcome, result, files, title) = match made {
        Ok(made) => (Outcome::Done, Ok(made.mesh), made.files, made.title),
        Err(failure) => (failure.outcome, Err(failure.error), Vec::new(), shown.to_string()),
    };
    let statistics = Statistics::new(stages, &result, total);
    let mut text = String::new();
    if stages.boundary.is_some() {
        text.push_str(&report::table(&title, stages, &statistics));
    }
    if let Err(error) = &result {
        match error {
            // It names the file itself.
            Error::Io { .. } => eprintln!("quadrel: {error}"),
            _ => eprintln!("quadrel: {shown}: {error}"),
        }
    }
    let mut written = Vec::new();
    let mut keep = |written_now: Result<Vec<PathBuf>>| match written_now {
        Ok(paths) => written.extend(paths),
        Err(error) => {
            eprintln!("quadrel: {error}");
            outcome = Outcome::Unusable;
        }
    };
    if let Ok(mesh) = &result {
        keep(write_meshes(mesh, &files));
    }
    if let Some(folder) = &arguments.stages {
        keep(write_pictures(folder, stages, &result));
    }
    if let Some(path) = &arguments.stats {
        let bytes = statistics.to_json_text().into_bytes();
        keep(output::write_files(&[(path.clone(), bytes)]).map(|()| vec![path.clone()]));
    }
    for path in &written {
        text.push_str(&format!("wrote {}\n", path.display()));
    }
    if result.is_ok() && files.is_empty() {
        text.push_str("the mesh was not written: name a file with -o\n");
    }
    (outcome, text)
}

/// The files of the mesh, each with its format.
fn output_files(arguments: &MeshArguments) -> Result<Vec<(PathBuf, Format)>> {
    let format = arguments.format.as_deref().map(Format::from_name).transpose()?;
    if arguments.domain.is_none() && arguments.output.is_empty() {
        let shown = [Format::Vtu, Format::Svg];
        return Ok(shown.map(|f| (PathBuf::from(format!("gingerbread.{}", f.name())), f)).to_vec());
    }
    let with_format =
        |path: &PathBuf| Ok((path.clone(), format.map_or_else(|| Format::from_path(path), Ok)?));
    arguments.output.iter().map(with_format).collect()
}

/// Refuses early what could not be written in the end.
fn check_writable(path: &Path, domain: Option<&Path>) -> Result<()> {
    let refuse = |reason: &str| Err(Error::Io { path: path.display().to_string(), reason: reason.into() });
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    if folder.is_some_and(|f| !f.is_dir()) {
        return refuse("its folder does not exist; make it first");
    }
    if path.is_dir() {
        return refuse("is a folder; give a file name");
    }
    let same = |other: &Path| matches!((path.canonicalize(), other.canonicalize()), (Ok(a), Ok(b)) if a == b);
    if domain.is_some_and(same) {
        return refuse("is the domain's own file; give another name");
    }
    Ok(())
}

/// Options as far as the arguments alone say them.
fn options(arguments: &MeshArguments) -> Result<Options> {
    let mut options = Options {
        norm: arguments.norm.into(),
        field: arguments.field.into(),
        effort: arguments.effort.into(),
        max_element_size: arguments.max_size,
        symmetry: !arguments.no_symmetry,
        progress: if arguments.log_stages { progress::log() } else { progress::terminal() },
        ..Options::default()
    };
    if let Some(expression) = &arguments.size {
        options.element_size = Some(size_function(expression)?);
    }
    if let Some(order) = arguments.order {
        options.order = order;
    }
    if let Some(floor) = arguments.quality_floor {
        options.quality_floor = floor;
    }
    match (arguments.tolerance, arguments.relative) {
        (Some(e), _) => options.tolerance = Tolerance::Absolute(e),
        (_, Some(e)) => options.tolerance = Tolerance::Relative(e),
        _ => {}
    }
    Ok(options)
}

/// The size that an expression in x and y describes.
fn size_function(text: &str) -> Result<SizeFunction> {
    let expression = Expression::parse_of(text, &["x", "y"], 1, 1).map_err(|error| match error {
        Error::Parse { what, column, .. } => {
            let what = format!("--size, column {column}: {what}");
            Error::Unsupported { what }
        }
        other => other,
    })?;
    Ok(SizeFunction::new(move |p| expression.value(&p)))
}

/// Adds what the arguments left open and the file says.
fn complete(options: &mut Options, arguments: &MeshArguments, model: &Model) -> Result<()> {
    let embedded = arguments.domain.is_none();
    let order = if embedded { Some(EMBEDDED_ORDER) } else { model.order };
    let tolerance = if embedded { Some(EMBEDDED_TOLERANCE) } else { model.tolerance };
    if let (None, Some(order)) = (arguments.order, order) {
        options.order = order;
    }
    if let (None, None, Some(e)) = (arguments.tolerance, arguments.relative, tolerance) {
        options.tolerance = Tolerance::Absolute(e);
    }
    if let (true, Some(of_file)) = (arguments.refinement_regions, &model.size) {
        let own = options.element_size.take();
        options.element_size = Some(own.map_or(of_file.clone(), |own| own.min(of_file.clone())));
    }
    if arguments.background_size {
        let Some(background) = model.background_size else {
            let what = "--background-size: the file has no background grid; leave it out".into();
            return Err(Error::Unsupported { what });
        };
        options.max_element_size = Some(options.max_element_size.map_or(background, |h| h.min(background)));
    }
    options.check()
}

fn write_meshes(mesh: &HighOrderMesh, files: &[(PathBuf, Format)]) -> Result<Vec<PathBuf>> {
    let rendered = files.iter().map(|(path, format)| Ok((path.clone(), format.render(mesh)?)));
    let rendered: Vec<_> = rendered.collect::<Result<_>>()?;
    output::write_files(&rendered)?;
    Ok(rendered.into_iter().map(|(path, _)| path).collect())
}

/// A numbered picture of every stage reached, the mesh, and one with all of them side by side.
fn write_pictures(folder: &Path, stages: &Stages, result: &Result<HighOrderMesh>) -> Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder)
        .map_err(|e| Error::Io { path: folder.display().to_string(), reason: e.to_string() })?;
    let place = result.as_ref().err().and_then(Error::place);
    let mut pictures: Vec<(String, String)> = svg::Picture::ALL
        .into_iter()
        .enumerate()
        .filter_map(|(k, p)| Some((format!("{k}-{}.svg", p.name()), svg::stage(stages, p, place)?)))
        .collect();
    if let Ok(mesh) = result {
        pictures.push((format!("{}-mesh.svg", svg::Picture::ALL.len()), svg::mesh(mesh)));
    }
    pictures.push(("stages.svg".into(), svg::overview(stages, result.as_ref().ok(), place)));
    let files: Vec<_> = pictures.into_iter().map(|(n, text)| (folder.join(n), text.into_bytes())).collect();
    output::write_files(&files)?;
    Ok(vec![folder.to_path_buf()])
}
