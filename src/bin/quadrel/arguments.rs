//! What can be said on the command line.

use clap::{Args, Parser, Subcommand, ValueEnum};
use quadrel::options::{Effort, FieldMethod, Norm};
use std::path::PathBuf;

/// Curved all-quadrilateral meshes of planar domains for spectral element methods.
#[derive(Parser)]
#[command(version, args_conflicts_with_subcommands = true)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Option<Command>,
    #[command(flatten)]
    pub mesh: MeshArguments,
}

#[derive(Subcommand)]
pub enum Command {
    /// Mesh every domain of some folders, each in a process of its own, and sum up
    Corpus(CorpusArguments),
}

#[derive(Args)]
pub struct MeshArguments {
    /// A HOHQMesh control file (.control) or an SVG path (.svg); without it the Gingerbread man is
    /// meshed with order 5 and L2 tolerance 1e-2 to gingerbread.vtu and gingerbread.svg
    #[arg(value_name = "DOMAIN")]
    pub domain: Option<PathBuf>,
    /// Polynomial order of the elements, 1 to 32 [default: the file's, else 5]
    #[arg(long, value_name = "N")]
    pub order: Option<usize>,
    /// Largest error of a boundary edge, in the norm's own unit [default: the file's, else relative 1e-5]
    #[arg(long, value_name = "E", conflicts_with = "relative", allow_negative_numbers = true)]
    pub tolerance: Option<f64>,
    /// The same for the domain scaled to a bounding-box diagonal of 1
    #[arg(long, value_name = "E", allow_negative_numbers = true)]
    pub relative: Option<f64>,
    /// Norm of the boundary error
    #[arg(long, value_enum, default_value_t = NormName::L2)]
    pub norm: NormName,
    /// Largest wanted element size; the finished mesh is divided into equal parts
    #[arg(long, value_name = "H", allow_negative_numbers = true)]
    pub max_size: Option<f64>,
    /// Largest wanted element size as an expression in x and y (+ - * / ^, sin, exp, sqrt, min(a, b) and
    /// so on); with --max-size the smaller of both holds
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub size: Option<String>,
    /// Apply the sizes of the control file's REFINEMENT_CENTER and REFINEMENT_LINE blocks; without it, they are
    /// not used
    #[arg(long)]
    pub refinement_regions: bool,
    /// Take the size of the control file's background grid as largest element size; without it, it is not used
    #[arg(long)]
    pub background_size: bool,
    /// Share of the best possible scaled Jacobian that coarsening does not take elements below
    #[arg(long, value_name = "Q", allow_negative_numbers = true)]
    pub quality_floor: Option<f64>,
    /// Mesh a symmetric domain without regard to its symmetries
    #[arg(long)]
    pub no_symmetry: bool,
    /// How much work fewer elements are worth: fast takes about two thirds of the time for about 5 % more of them,
    /// best takes the best of four meshes
    #[arg(long, value_enum, default_value_t = EffortName::Default)]
    pub effort: EffortName,
    /// Cross field: diffused keeps singularities apart, harmonic is the paper's; where one leads to a poor mesh or none
    /// the other is tried, too
    #[arg(long, value_enum, default_value_t = FieldName::Diffused)]
    pub field: FieldName,
    /// Number of threads; the mesh never depends on it (this version uses one)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Which component of a file with several, counted from 0 by descending area
    #[arg(long, value_name = "K")]
    pub component: Option<usize>,
    /// File to write the mesh to, its format by its extension, which is a format's name or .mesh for ism-v2; may
    /// be given several times
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Format of every -o, whatever the extension: vtu, msh, ism, ism-v2, ism-mm, inp, mfem or svg
    #[arg(long, value_name = "FORMAT")]
    pub format: Option<String>,
    /// Folder for a picture of every stage reached, also on failure
    #[arg(long, value_name = "DIR")]
    pub stages: Option<PathBuf>,
    /// File for the statistics (JSON), also on failure
    #[arg(long, value_name = "FILE.json")]
    pub stats: Option<PathBuf>,
    /// Write a line to standard error at the beginning of each stage
    #[arg(long, hide = true)]
    pub log_stages: bool,
}

#[derive(Args)]
pub struct CorpusArguments {
    /// Folders that are searched for .control and .svg files
    #[arg(value_name = "DIR", required_unless_present = "reduce")]
    pub folders: Vec<PathBuf>,
    /// Polynomial order of the elements [default: the file's, else 5]
    #[arg(long, value_name = "N")]
    pub order: Option<usize>,
    /// Boundary tolerance relative to the domain's diagonal [default: the file's, else 1e-5]
    #[arg(long, value_name = "E")]
    pub relative: Option<f64>,
    /// Domains meshed at a time
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..=256))]
    pub jobs: u16,
    /// Seconds after which a run is ended
    #[arg(long, value_name = "S", default_value_t = 120.0)]
    pub limit_seconds: f64,
    /// File for a table with a row a domain and all statistics
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Instead: take holes out of this domain while it fails in the same way, and write the smallest
    /// such file beside it
    #[arg(long, value_name = "FILE")]
    pub reduce: Option<PathBuf>,
    /// Folder for the meshes (.vtu) and pictures (.svg)
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum NormName {
    L2,
    H1,
    Max,
}

impl From<NormName> for Norm {
    fn from(name: NormName) -> Norm {
        match name {
            NormName::L2 => Norm::L2,
            NormName::H1 => Norm::H1,
            NormName::Max => Norm::Max,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub enum FieldName {
    Diffused,
    Harmonic,
}

impl From<FieldName> for FieldMethod {
    fn from(name: FieldName) -> FieldMethod {
        match name {
            FieldName::Diffused => FieldMethod::Diffused,
            FieldName::Harmonic => FieldMethod::Harmonic,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub enum EffortName {
    Fast,
    Default,
    Best,
}

impl From<EffortName> for Effort {
    fn from(name: EffortName) -> Effort {
        match name {
            EffortName::Fast => Effort::Fast,
            EffortName::Default => Effort::Default,
            EffortName::Best => Effort::Best,
        }
    }
}
