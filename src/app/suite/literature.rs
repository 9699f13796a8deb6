//! The problems of the literature, as they are in `problems/literature`, built into the program: the suite runs
//! anywhere.

use crate::files::diagnostic::Diagnostic;
use crate::files::problem_file;
use crate::files::problem_file::ProblemFile;

/// Includes a file of `problems/literature` with its name there.
macro_rules! file {
    ($name:literal) => {
        ($name, include_str!(concat!("../../../problems/literature/", $name)))
    };
}

/// The problem files, by name.
pub const PROBLEMS: [(&str, &str); 16] = [
    file!("a6.toml"),
    file!("a6b.toml"),
    file!("e5.toml"),
    file!("e5-free.toml"),
    file!("k18.toml"),
    file!("k18b.toml"),
    file!("k18f.toml"),
    file!("l10.toml"),
    file!("p12.toml"),
    file!("shape-L.toml"),
    file!("shape-S.toml"),
    file!("shape-figure-8.toml"),
    file!("shape-heart.toml"),
    file!("shape-letter-D.toml"),
    file!("shape-square.toml"),
    file!("v6.toml"),
];

/// The points files that the problem files refer to, by name.
pub const POINTS: [(&str, &str); 6] = [
    file!("shapes/L.csv"),
    file!("shapes/S.csv"),
    file!("shapes/figure-8.csv"),
    file!("shapes/heart.csv"),
    file!("shapes/letter-D.csv"),
    file!("shapes/square.csv"),
];

/// Returns every problem with the name of its file.
///
/// # Errors
/// The [`Diagnostic`] of a file that is not a valid problem file: a fault of this program.
pub fn problems() -> Result<Vec<(&'static str, ProblemFile)>, Box<Diagnostic>> {
    let read = |(name, text)| Ok((name, problem_file::parse_beside(name, text, &POINTS, &[])?));
    PROBLEMS.into_iter().map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn the_program_holds_the_problems_of_the_folder_and_reads_the_same_from_them() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/literature");
        let mut names = Vec::new();
        for place in [folder.clone(), folder.join("shapes")] {
            for entry in std::fs::read_dir(&place).expect("it is there") {
                let path = entry.expect("it can be read").path();
                if path.is_file() {
                    let name = path.strip_prefix(&folder).expect("it is in it");
                    names.push(name.to_string_lossy().replace('\\', "/"));
                }
            }
        }
        let mut held: Vec<&str> = PROBLEMS.iter().chain(&POINTS).map(|(name, _)| *name).collect();
        names.sort_unstable();
        held.sort_unstable();
        assert_eq!(names, held);
        for (name, problem) in problems().expect("they are problems") {
            let mut read = problem_file::load(&folder.join(name), &[]).expect("it is a problem");
            read.warnings.clear();
            let problem = ProblemFile { warnings: Vec::new(), ..problem };
            assert_eq!(problem, read, "{name}");
        }
    }
}
