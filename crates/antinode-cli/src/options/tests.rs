//! Help is wrapped well whatever the terminal's width.

use clap::CommandFactory;

use super::Options;

/// The help texts of the command and of all its subcommands in a terminal of this width, each with the text below it.
fn helps(width: usize) -> Vec<(String, String)> {
    let mut all = Options::command().term_width(width);
    all.build();
    let mut commands = vec![all];
    let mut helps = Vec::new();
    while let Some(mut command) = commands.pop() {
        commands.extend(command.get_subcommands().cloned());
        let under = command
            .get_after_help()
            .map_or(String::new(), |under| under.to_string());
        for help in [command.render_help(), command.render_long_help()] {
            helps.push((help.to_string(), under.clone()));
        }
    }
    helps
}

#[test]
fn help_fits_terminals_of_80_and_of_100_columns() {
    for width in [80, 100] {
        let helps = helps(width);
        assert!(helps.len() > 20);
        for (help, under) in helps {
            let lines: Vec<&str> = help.lines().collect();
            for line in &lines {
                assert!(line.chars().count() <= width, "{width}: {line}");
            }
            for line in under.lines().filter(|line| line.starts_with(' ')) {
                assert!(lines.contains(&line), "{width}: {line}");
            }
            // A line of a paragraph ends only if the next word does not fit.
            for pair in lines.windows(2) {
                let word = pair[1].split(' ').next().unwrap_or_default();
                let room = width.saturating_sub(pair[0].chars().count());
                let is_full = room <= word.chars().count();
                assert!(
                    pair[0].is_empty() || word.is_empty() || is_full,
                    "{width}: {}",
                    pair[0]
                );
            }
        }
    }
}
