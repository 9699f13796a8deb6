//! Options of `balance`.

use crate::app::cli::arguments::finite;
use clap::{ArgGroup, Args, ValueEnum};
use std::path::PathBuf;

/// Options of `balance`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("means").required(true).args(["spring", "torsion", "masses"]))]
pub struct Balance {
    /// A linkage file (TOML), a result's folder or record.json (its first candidate), either with `:2` for another
    pub linkage: PathBuf,
    /// Loads in a file of their own, in place of those of the linkage file
    #[arg(long, value_name = "FILE")]
    pub loads: Option<PathBuf>,
    /// A spring between two ends: a joint's name, a fixed point such as 50,80, or a place on a body such as coupler:20,5
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_hyphen_values = true)]
    pub spring: Option<Vec<String>>,
    /// A torsion spring on a body, against another [default: the ground]
    #[arg(long, num_args = 1..=2, value_names = ["BODY", "AGAINST"])]
    pub torsion: Option<Vec<String>>,
    /// The crank angles over which a spring is to hold, degrees [default: all that the crank reaches]
    #[arg(long, value_name = "FROM,TO", value_delimiter = ',', allow_hyphen_values = true, value_parser = finite)]
    pub over: Option<Vec<f64>>,
    /// The rates of the springs that can be bought, N/m or N m/rad [default: any]
    #[arg(long, value_name = "RATE,..", value_delimiter = ',', allow_hyphen_values = true, value_parser = finite)]
    pub rates: Vec<f64>,
    /// The least free length of a spring, in the linkage's unit
    #[arg(long, value_name = "L", default_value = "0", allow_negative_numbers = true, value_parser = finite)]
    pub least_free_length: f64,
    /// Counter-masses on these bodies: crank, follower, or both
    #[arg(long, value_name = "BODY,..", value_delimiter = ',')]
    pub masses: Option<Vec<String>>,
    /// The distance of the masses from the fixed pivots, in the linkage's unit
    #[arg(long, value_name = "R", requires = "masses", allow_negative_numbers = true, value_parser = finite)]
    pub radius: Option<f64>,
    /// The quantity that the masses even out over a turn
    #[arg(long, value_enum, default_value = "torque", requires = "masses")]
    pub even: Even,
    /// Speed of the crank for the masses, rad/s
    #[arg(long, value_name = "W", requires = "masses", allow_negative_numbers = true, value_parser = finite)]
    pub omega: Option<f64>,
    /// Speed of the crank for the masses, turns a minute
    #[arg(long, value_name = "N", requires = "masses", conflicts_with = "omega", allow_negative_numbers = true, value_parser = finite)]
    pub rpm: Option<f64>,
    /// Write the loads with the balance, as a file for `analyze --loads`
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Replace a file that is there even where linkwright did not write it, or where this command reads it
    #[arg(long)]
    pub force: bool,
    /// Print JSON instead of the table
    #[arg(long)]
    pub json: bool,
}

/// The quantity that counter-masses even out over a turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Even {
    /// The torque on the crank.
    Torque,
    /// The shaking force on the ground.
    ShakingForce,
    /// Both.
    Both,
}
