use super::*;

const TEXT: &str = "\
title: \"a: b\" # materials: none
materials:
  clay: {model: tresca, young: {top: 1, gradient: 2}}
phases:
  - name: one
    table: [[0, 1], [2, 3]]
more: &more {a: 1}
again: *more
";

fn path(text: &str) -> Path {
    text.split('.').fold(Path::default(), |path, step| match step.parse() {
        Ok(index) => path.index(index),
        Err(_) => path.key(step),
    })
}

fn read(text: &str) -> Value {
    let mut faults = Vec::new();
    let value = parse(text).unwrap().to_json(&mut faults);
    assert!(faults.is_empty(), "{faults:?}");
    value
}

#[test]
fn keys_and_values_are_found_in_block_and_flow_style() {
    let cases = [
        ("title", At::Key, (1, 1)),
        ("title", At::Value, (1, 8)),
        ("materials.clay", At::Key, (3, 3)),
        ("materials.clay.model", At::Value, (3, 17)),
        ("materials.clay.young.gradient", At::Key, (3, 41)),
        ("phases.0.name", At::Value, (5, 11)),
        ("phases.0.table.1.0", At::Value, (6, 22)),
        ("again", At::Key, (8, 1)),
        ("again.a", At::Key, (7, 14)),
    ];
    let node = parse(TEXT).unwrap();
    for (at_path, at, place) in cases {
        assert_eq!(node.locate(&path(at_path), at), Some(place), "{at_path}");
    }
    for missing in ["nothing", "materials.sand", "phases.7", "title.sub", "materials.0"] {
        assert_eq!(node.locate(&path(missing), At::Value), None, "{missing}");
    }
}

#[test]
fn plain_scalars_are_what_the_core_schema_says() {
    let list = "[1, -1, +1, 0x1F, -0o17, 0b101, 1e-6, .5, -5., 1.0e+3, 18446744073709551615, -9223372036854775808]";
    let numbers = serde_json::json!([
        1,
        -1,
        1,
        31,
        -15,
        5,
        1e-6,
        0.5,
        -5.0,
        1000.0,
        18446744073709551615u64,
        -9223372036854775808i64
    ]);
    assert_eq!(read(list), numbers);
    let texts = ["01", "1_000", "inf", "nan", "1e999", "++1", "+-1", "0x", "0x+1", "1 2", "yes", "on", "1:30", "é土"];
    for text in texts {
        assert_eq!(read(&format!("- {text}\n")), serde_json::json!([text]), "{text}");
    }
    let others = serde_json::json!({"a": [null, null, true, false, "1", "true"], "b": null, "c": {"d": null}});
    assert_eq!(read("a: [~, null, true, FALSE, '1', \"true\"]\nb:\nc: {d}\n"), others);
    assert_eq!(read(""), Value::Null);
    assert_eq!(read("# nothing\n"), Value::Null);
}

#[test]
fn flow_style_may_run_over_lines() {
    let text = "a: {\n  b: [1,\n 2\n  ],\n}\nc: \"one\n  two\"\nd: # nothing\n- 1\n";
    assert_eq!(read(text), serde_json::json!({"a": {"b": [1, 2]}, "c": "one two", "d": [1]}));
}

#[test]
fn an_alias_is_what_its_anchor_is() {
    assert_eq!(read(TEXT)["again"], serde_json::json!({"a": 1}));
}

#[test]
fn what_is_beyond_the_limits_is_refused_at_once() {
    let told = |text: &str| parse(text).unwrap_err().problem;
    assert!(told(&"[".repeat(1_000_000)).contains("nested"));
    assert!(told(&"[\n ".repeat(1_000_000)).contains("nested"));
    assert!(told(&"- ".repeat(1_000_000)).contains("nested"));
    assert!(told(&"? ".repeat(1_000_000)).contains("nested"));
    assert!(told(&"{a: ".repeat(100_000)).contains("nested"));
    assert!(told(&" ".repeat(MOST_BYTES + 1)).contains("bytes"));
    // Tenfold at each level, in breadth and in depth.
    let wide = |i: usize| format!("a{i}: &a{i} [{}]\n", vec![format!("*a{}", i - 1); 10].join(", "));
    let wide = "a0: &a0 [1]\n".to_owned() + &(1..10).map(wide).collect::<String>();
    assert!(told(&wide).contains("aliases"));
    let deep = |i: usize| format!("a{i}: &a{i} [[[[*a{}]]]]\n", i - 1);
    let deep = "a0: &a0 [1]\n".to_owned() + &(1..100_000).map(deep).collect::<String>();
    assert!(told(&deep).contains("nested"));
    let long = format!("a: &a {}\nb: [{}]\n", "x".repeat(100_000), vec!["*a"; 9_999].join(", "));
    assert!(told(&long).contains("aliases"));
    assert!(told(&format!("{}: 1\n", "k".repeat(1000))).contains("the key has more than 200"));
    assert!(told("a: &a [*a]").contains("within"));
}

#[test]
fn what_no_case_has_is_refused_with_its_place() {
    let told = |text: &str| parse(text).map(|_| ()).unwrap_err();
    assert_eq!(told("a: 1\nb:\n  c: 1\n  c: 2\n").place, Some((4, 3)));
    assert!(told("a: 1\na: 2\n").problem.contains("`a` is a duplicate"));
    assert!(told("a: 1\n---\nb: 2\n").problem.contains("more than one document"));
    // A parser that takes a zero for the end would not see what is behind it.
    assert_eq!(told("a: 1\nb: \0\nc: 3\n").place, Some((2, 4)));
    assert!(told("a: \u{1b}[31mred\n").problem.contains("U+001B"));
    assert!(told("a: *b\n").problem.contains("anchor"));
}
