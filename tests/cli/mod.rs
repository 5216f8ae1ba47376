//! The program from outside: its stages and their output folder, messages, signals, `--resume`, and `make`.

mod broken_input;
mod files_of_others;
mod make;
mod new;
mod output_folder;
mod pictures;
mod plot;
mod report;
mod running;
mod shell;
mod signals;
mod stages;
mod sweep;

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    mod new;
    mod resume;
    mod start;
    mod sweep;
}
