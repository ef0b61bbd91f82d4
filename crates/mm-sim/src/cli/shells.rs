//! `mmsim completions` and `mmsim man`: what shells and `man` know of the command.

use std::path::Path;

use clap::CommandFactory as _;
use clap_complete::Shell;

use super::{Cli, Exit, complain, print_bytes};

/// Prints the completions of a shell.
pub(super) fn completions(shell: Shell) -> Exit {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "mmsim", &mut script);
    print_bytes(&script)
}

/// Prints the page of the command, or writes one for each command to a folder: `mmsim.1`, `mmsim-fis.1`, `mmsim-fis-eval.1`.
pub(super) fn man(out: Option<&Path>) -> Exit {
    let done = match out {
        None => {
            let mut page = Vec::new();
            clap_mangen::Man::new(Cli::command()).render(&mut page).map(|()| print_bytes(&page))
        }
        Some(folder) => std::fs::create_dir_all(folder)
            .and_then(|()| clap_mangen::generate_to(Cli::command(), folder))
            .map(|()| Exit::Done),
    };
    done.unwrap_or_else(|error| {
        let folder = out.map_or_else(|| "standard output".to_owned(), |folder| folder.display().to_string());
        complain(&format_args!("error: cannot write the manual to {folder}: {error}"));
        Exit::Failed
    })
}
