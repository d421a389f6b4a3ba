//! The interface of the command line in docs/commands.md is that of `--help`. Run with `TELLUS_BLESS=1` to write its
//! list of options anew.

use std::path::PathBuf;

fn help(args: &[&str]) -> String {
    let output = assert_cmd::cargo::cargo_bin_cmd!("tellus").args(args).arg("--help").output().unwrap();
    assert!(output.status.success(), "{args:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// The names of the subcommands.
fn commands() -> Vec<String> {
    let help = help(&[]);
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    listed.map(|line| line.split_whitespace().next().unwrap().to_owned()).filter(|name| name != "help").collect()
}

/// An option as its help shows it.
struct Opt {
    name: String,
    /// The name of its value; empty for a flag.
    value: String,
    /// The values that it may have, if they are listed.
    possible: Vec<String>,
}

/// The options of a subcommand, and its help.
fn options(command: &str) -> (Vec<Opt>, String) {
    let help = help(&[command]);
    let mut options: Vec<Opt> = Vec::new();
    let listed = help.lines().skip_while(|line| *line != "Options:").skip(1);
    for line in listed {
        let words: Vec<&str> = line.split_whitespace().collect();
        // What they mean is indented further.
        let is_option = line.find('-').is_some_and(|at| at <= 6 && line[..at].trim().is_empty());
        if is_option && !words.contains(&"--help") {
            let at = words.iter().position(|word| word.starts_with("--")).unwrap();
            let value =
                words.get(at + 1).and_then(|word| word.strip_prefix('<')).map(|word| word.trim_end_matches(['>', '.']));
            options.push(Opt {
                name: words[at].to_owned(),
                value: value.unwrap_or_default().to_owned(),
                possible: Vec::new(),
            });
        }
        if let (Some(option), Some((_, values))) = (options.last_mut(), line.split_once("[possible values: ")) {
            option.possible = values.trim_end_matches(']').split(", ").map(str::to_owned).collect();
        }
    }
    (options, help)
}

fn document() -> (PathBuf, String) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/commands.md");
    let text = std::fs::read_to_string(&path).unwrap();
    (path, text)
}

/// What scripts may count on is there: commands, options, names of values, values.
#[test]
fn what_scripts_count_on_is_there() {
    let (_, text) = document();
    let promised = text.split("\n```text\n").nth(1).unwrap().split("\n```").next().unwrap();
    let mut count = 0;
    for line in promised.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let (options, help) = options(words[1]);
        for (k, word) in words.iter().enumerate().skip(2).filter(|(_, word)| word.starts_with('-')) {
            let name = if *word == "-o" { "--output" } else { word };
            let option = options.iter().find(|option| option.name == name);
            let option = option.unwrap_or_else(|| panic!("tellus {} has no {name}:\n{help}", words[1]));
            let value = words.get(k + 1).filter(|word| !word.starts_with('-')).copied().unwrap_or_default();
            let is_there = |value: &str| option.possible.iter().any(|possible| possible == value);
            let agrees = option.value == value || (value.contains('|') && value.split('|').all(is_there));
            assert!(agrees, "{line}: {name} has <{}>, {:?}", option.value, option.possible);
            count += 1;
        }
    }
    assert!(count > 45, "{count} options");
}

/// Each option of each subcommand is in the list, and nothing else.
#[test]
fn the_list_of_options_is_that_of_the_help() {
    let mut list = String::new();
    for command in commands() {
        let (options, _) = options(&command);
        list += &format!("{command}:");
        for option in options {
            list += &format!(" {}", option.name);
            if !option.value.is_empty() {
                list += &format!(" {}", option.value);
            }
        }
        list.push('\n');
    }
    let (path, text) = document();
    let (before, kept) = text.rsplit_once("\n```text\n").unwrap();
    let kept = kept.strip_suffix("```\n").unwrap();
    if std::env::var_os("TELLUS_BLESS").is_some() {
        std::fs::write(&path, format!("{before}\n```text\n{list}```\n")).unwrap();
    } else {
        assert!(
            kept == list,
            "docs/commands.md is old; TELLUS_BLESS=1 cargo test --test cli interface writes it anew:\n{list}"
        );
    }
}

/// The table of the README names each subcommand, and only options that there are.
#[test]
fn the_readme_names_commands_and_options_that_there_are() {
    let text = std::fs::read_to_string(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("README.md")).unwrap();
    let table = text.split("## The command line").nth(1).unwrap().split("```text\n").nth(1).unwrap();
    let table = table.split("\n```").next().unwrap();
    let all = commands();
    let mut named: Vec<&str> = Vec::new();
    let mut current: Vec<&str> = Vec::new();
    for line in table.lines() {
        let first = line.strip_prefix("tellus ").and_then(|rest| rest.split(' ').next());
        if let Some(names) = first.filter(|name| name.starts_with(char::is_lowercase)) {
            current = names.split('|').collect();
            named.extend(&current);
        }
        let words = line.split([' ', ':', ',', ';', '[', ']', '.', '`']).filter(|word| word.starts_with("--"));
        for word in words {
            // `render` in the line of `system` has options of its own.
            let others = line.split('`').skip(1).step_by(2).filter(|word| all.iter().any(|name| name == word));
            let is_there = current
                .iter()
                .copied()
                .chain(others)
                .any(|name| options(name).0.iter().any(|option| option.name == word));
            assert!(is_there, "{line}: no {word}");
        }
    }
    for name in &all {
        assert!(named.contains(&name.as_str()), "the README's table lacks {name}");
    }
}
