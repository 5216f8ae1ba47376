use std::process::ExitCode;

fn main() -> ExitCode {
    mpm::cli::main()
}
