//! `mpm plot`: the curves that it draws, and what it says of columns and files that are not there.

use crate::support::{in_folder, python, said, succeeds};
use std::fs;
use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

/// A head that is pushed down by 1 cm a row and pulled a little in the end, with the load on it.
const HEAD: &str = "time [s],head.uy [m],head.reaction_y [kN],head.ux [m],pile.contact_x [kN]\n\
    0.1,-0.01,-2.5,0.0,0.5\n0.2,-0.02,-3.75,0.0,0.25\n0.3,-0.03,-4.0,0.0,-0.125\n0.35,-0.025,1.5,0.0,0.0\n";

const LOG: &str = "3 material points\n\
    step 1 push t 0.100000000 dt 1.000e-1 iterations 4 residuals 0.0e0 by Lu mass 0\n  halved: once\n\
    step 2 push t 0.200000000 dt 1.000e-1 iterations 9 residuals 0.0e0 by Lu mass 0\n\
    step 3 push t 0.300000000 dt 1.000e-1 iterations 2 residuals 0.0e0 by Lu mass 0\n\
    step 4 pull t 0.350000000 dt 5.000e-2 iterations 3 residuals 0.0e0 by Lu mass 0\n";

/// A folder with output folders `a` and `b`, in which all values but the time are half of the first.
fn runs() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, factor) in [("a", 1.0), ("b", 0.5)] {
        let halved = |line: &str| {
            let numbers = line.split(',').map(|number| number.parse::<f64>().unwrap()).enumerate();
            numbers.map(|(i, v)| (if i == 0 { v } else { factor * v }).to_string()).collect::<Vec<_>>().join(",")
        };
        let (heading, rows) = HEAD.split_once('\n').unwrap();
        let rows: Vec<String> = rows.lines().map(halved).collect();
        fs::create_dir(folder.path().join(name)).unwrap();
        fs::write(folder.path().join(name).join("history.csv"), format!("{heading}\n{}\n", rows.join("\n"))).unwrap();
        fs::write(folder.path().join(name).join("solve.log"), LOG).unwrap();
    }
    folder
}

fn plot(folder: &Path, arguments: &[&str]) -> Output {
    in_folder(folder, &[&["plot"], arguments].concat())
}

/// The SVG that is drawn.
fn svg(folder: &Path, arguments: &[&str]) -> String {
    succeeds(&plot(folder, &[arguments, &["-o", "p.svg"]].concat()));
    fs::read_to_string(folder.join("p.svg")).unwrap()
}

/// A number of an attribute.
fn attribute(line: &str, name: &str) -> Option<f64> {
    line.split_once(&format!(" {name}=\""))?.1.split('"').next()?.parse().ok()
}

/// The texts, with their place and which end of them is there.
fn texts(svg: &str) -> Vec<(String, [f64; 2], bool)> {
    let lines: Vec<&str> = svg.lines().collect();
    let texts = lines.windows(2).filter(|pair| pair[0].starts_with("<text"));
    texts
        .map(|pair| {
            let place = ["x", "y"].map(|name| attribute(pair[0], name).unwrap());
            (pair[1].to_owned(), place, pair[0].contains("text-anchor=\"end\""))
        })
        .collect()
}

/// The places of the lines of a colour, in the values that the ticks of the only chart have.
fn curves(svg: &str, colour: &str) -> Vec<Vec<[f64; 2]>> {
    let number = |text: &str| text.replace('−', "-").parse::<f64>().ok();
    let ticks: Vec<(f64, [f64; 2], bool)> =
        texts(svg).into_iter().filter_map(|(text, place, right)| Some((number(&text)?, place, right))).collect();
    // Labels of the vertical axis end at it, those of the horizontal one are about their place.
    let scale = [false, true].map(|right| {
        let d = usize::from(right);
        let ticks: Vec<_> = ticks.iter().filter(|tick| tick.2 == right).collect();
        let (first, last) = (ticks[0], ticks[ticks.len() - 1]);
        let per_unit = (last.0 - first.0) / (last.1[d] - first.1[d]);
        move |at: f64| first.0 + (at - first.1[d]) * per_unit
    });
    let stroke = format!("stroke=\"{colour}\"");
    let lines = svg.lines().filter(|line| line.starts_with("<polyline") && line.contains(&stroke));
    lines
        .map(|line| {
            let points = line.split_once("points=\"").unwrap().1.split('"').next().unwrap();
            let place = |pair: &str| {
                let (x, y) = pair.split_once(',').unwrap();
                [scale[0](x.parse().unwrap()), scale[1](y.parse().unwrap())]
            };
            points.split_whitespace().map(place).collect()
        })
        .collect()
}

const BLUE: &str = "#0072B2";
const ORANGE: &str = "#D55E00";

/// Whether places are those of a series, to a thousandth of the axes.
#[track_caller]
fn are(found: &[[f64; 2]], expected: &[[f64; 2]], ranges: [f64; 2]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((0..2).all(|d| (a[d] - b[d]).abs() < 1e-3 * ranges[d]), "{found:?} {expected:?}");
    }
}

#[test]
fn the_usual_curve_is_the_load_over_the_displacement_where_it_goes() {
    let folder = runs();
    let svg = svg(folder.path(), &["a"]);
    let [curve] = curves(&svg, BLUE).try_into().unwrap();
    are(&curve, &[[0.01, 2.5], [0.02, 3.75], [0.03, 4.0], [0.025, -1.5]], [0.03, 5.5]);
    for title in ["−head.uy [m]", "−head.reaction_y [kN]"] {
        assert!(texts(&svg).iter().any(|(text, ..)| text == title), "{title}");
    }
}

#[test]
fn depths_grow_downwards_curves_have_names_and_long_titles_stay_on_the_paper() {
    let folder = runs();
    let title = "A head that is pushed down by one centimetre a row and is then pulled a little in the end, with the load on it, twice";
    let arguments =
        ["a", "b", "--x", "head.reaction_y", "--y", "head.uy", "--scale-x", "-1", "--scale-y", "-1", "--down"];
    let names = [
        "--label",
        "first",
        "--label",
        "a name that is far too long for half of the width of the picture, so that it is made smaller",
    ];
    let drawn = svg(folder.path(), &[&arguments[..], &names, &["--title", title]].concat());
    // Deeper is lower on the paper.
    let lines = drawn
        .lines()
        .filter(|line| line.starts_with("<polyline") && line.contains(BLUE) && line.matches(',').count() == 4);
    let heights: Vec<f64> = lines
        .flat_map(|line| line.split_once("points=\"").unwrap().1.split('"').next().unwrap().split_whitespace())
        .map(|pair| pair.split_once(',').unwrap().1.parse().unwrap())
        .collect();
    assert!(heights.len() == 4 && heights[0] < heights[1] && heights[1] < heights[2], "{heights:?}");
    let texts = texts(&drawn);
    assert!(names.iter().skip(1).step_by(2).all(|name| texts.iter().any(|(text, ..)| text == name)), "{texts:?}");
    let lines: Vec<&String> =
        texts.iter().map(|(text, ..)| text).filter(|text| title.contains(text.as_str())).collect();
    assert_eq!(lines.iter().map(|line| line.as_str()).collect::<Vec<_>>().join(" "), title);
    assert!(lines.len() > 1);

    let few = plot(folder.path(), &["a", "b", "--y", "head.uy", "--label", "one", "-o", "q.svg"]);
    assert!(!few.status.success() && said(&few).contains("1 names for 2 curves"), "{}", said(&few));
}

#[test]
fn axes_with_logarithms_have_powers_of_ten_and_leave_out_what_has_none() {
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (-2..4).map(|i| format!("{:e},{:e}\n", 10f64.powi(i), 10f64.powi(-i))).collect();
    fs::write(folder.path().join("t.csv"), format!("a,b\n0,1\n{rows}")).unwrap();
    let output = plot(folder.path(), &["t.csv", "--x", "a", "--y", "b", "--log", "xy", "-o", "p.svg"]);
    succeeds(&output);
    assert!(said(&output).contains("1 places are left out"), "{}", said(&output));
    let drawn = fs::read_to_string(folder.path().join("p.svg")).unwrap();
    let circles = drawn.lines().filter(|line| line.starts_with("<circle"));
    let places: Vec<[f64; 2]> = circles.map(|line| ["cx", "cy"].map(|name| attribute(line, name).unwrap())).collect();
    assert_eq!(places.len(), 6, "{drawn}");
    // On a straight line, at equal distances.
    for pair in places.windows(3) {
        assert!((0..2).all(|d| (pair[2][d] - 2.0 * pair[1][d] + pair[0][d]).abs() <= 2.0), "{places:?}");
    }
    assert!(["0.01", "100"].iter().all(|tick| texts(&drawn).iter().any(|(text, ..)| text == tick)), "{drawn}");
    let none = plot(folder.path(), &["t.csv", "--x", "a", "--y", "b", "--scale-y", "-1", "--log", "y", "-o", "q.svg"]);
    assert!(!none.status.success() && said(&none).contains("no value is positive"), "{}", said(&none));
}

#[test]
fn an_empty_field_is_a_gap() {
    let folder = runs();
    fs::write(folder.path().join("a/history.csv"), "time [s],p.uy [m]\n0,1\n1,2\n2,\n3,1\n4,2\n").unwrap();
    let drawn = svg(folder.path(), &["a", "--y", "p.uy"]);
    let curves = curves(&drawn, BLUE);
    assert_eq!(curves.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
}

#[test]
fn any_columns_are_drawn_of_several_runs_with_what_they_are_compared_to() {
    let folder = runs();
    fs::write(folder.path().join("ref.csv"), "t,F\n0.1,1\n0.3,2\n").unwrap();
    let arguments =
        ["a", "b", "--x", "time [s]", "--y", "head.reaction_y", "--scale-y", "-2", "--reference", "ref.csv"];
    let svg = svg(folder.path(), &[&arguments[..], &["--line", "limit=9"]].concat());
    let times = [0.1, 0.2, 0.3, 0.35];
    for (colour, factor) in [(BLUE, 1.0), (ORANGE, 0.5)] {
        // The legend has a line of the colour, too.
        let curves = curves(&svg, colour);
        let loads = [5.0, 7.5, 8.0, -3.0].map(|load| factor * load);
        let expected: Vec<[f64; 2]> = times.iter().zip(loads).map(|(&t, load)| [t, load]).collect();
        are(&curves[0], &expected, [0.25, 12.0]);
        assert_eq!(curves.len(), 2);
    }
    assert_eq!(svg.matches("<circle").count(), 3, "two values and the legend");
    let texts: Vec<String> = texts(&svg).into_iter().map(|(text, ..)| text).collect();
    for text in ["a", "b", "ref", "limit", "push", "pull", "−2 × head.reaction_y [kN]", "time [s]"] {
        assert!(texts.iter().any(|other| other == text), "{text}: {texts:?}");
    }
}

#[test]
fn the_work_of_the_solver_is_that_of_the_log() {
    let folder = runs();
    let svg = svg(folder.path(), &["a", "--iterations"]);
    assert_eq!(svg.matches(&format!("stroke=\"{BLUE}\"")).count(), 3, "iterations, sizes and halvings");
    assert!(texts(&svg).iter().any(|(text, ..)| text == "iterations of a step"));
}

#[test]
fn a_png_has_ink_in_the_colour_of_the_curve() {
    let folder = runs();
    succeeds(&plot(folder.path(), &["a", "-o", "p.png"]));
    let bytes = fs::read(folder.path().join("p.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(info.width, 1440);
    let ink = |colour: [u8; 3]| pixels.chunks_exact(3).filter(|pixel| **pixel == colour).count();
    assert!(ink([0, 114, 178]) > 1000 && ink([255, 255, 255]) > 100_000 && ink([40, 40, 40]) > 1000);
}

#[test]
fn columns_are_listed_and_one_that_is_not_there_has_near_ones() {
    let folder = runs();
    let listed = said(&plot(folder.path(), &["a", "--list"]));
    assert!(listed.contains("head.reaction_y [kN]  -4 … 1.5") && listed.contains("4 rows"), "{listed}");
    let output = plot(folder.path(), &["a", "--y", "haed.uy"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("a has no column `haed.uy`; near to it are `head.uy`"), "{}", said(&output));
    for (arguments, problem) in [
        (&["a", "-o", "p.pdf"][..], "pictures are SVG or PNG"),
        (&["c"], "there is no such case or folder"),
        (&["."], "there is no history.csv of a run"),
        (&["a", "--line", "high"], "`high` is no number"),
        (&["a", "--x", "time", "--line", "3"], "nothing says which one it belongs to"),
        (&["a", "--scale-x", "-1"], "the default curves have signs of their own"),
        (&["a", "--reference", "a/history.csv"], "it has 5 columns, not two"),
    ] {
        let output = plot(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(said(&output).contains(problem), "{arguments:?}: {}", said(&output));
    }
}

/// The table of a sweep with a parameter of numbers, one of texts, a run that ended early and one without a result.
const SWEEP: &str = "run,h,model,state,time [s],a.uy last [m],a.uy max [m]\n\
    r1,0.4,soft,finished,1.0,-2.0,0.5\nr2,0.1,soft,finished,1.0,-3.0,0.25\nr3,0.2,soft,finished,1.0,-2.5,0.75\n\
    r4,0.4,\"<b>, stiff\",finished,1.0,-1.0,0.0\nr5,0.1,\"<b>, stiff\",\"ended early: no step\",0.5,-1.5,0.0\n\
    r6,0.2,\"<b>, stiff\",not run,,,\n";

fn sweep() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("sweep")).unwrap();
    fs::write(folder.path().join("sweep/table.csv"), SWEEP).unwrap();
    folder
}

#[test]
fn a_quantity_of_a_sweep_is_drawn_over_a_parameter_a_curve_for_each_value_of_the_others() {
    let folder = sweep();
    // The first parameter without --x, and the folder for its table.
    for arguments in [&["sweep/table.csv", "--x", "h"][..], &["sweep"]] {
        let svg = svg(folder.path(), &[arguments, &["--y", "a.uy last", "--scale-y", "-1"]].concat());
        are(&curves(&svg, BLUE)[0], &[[0.1, 3.0], [0.2, 2.5], [0.4, 2.0]], [0.3, 2.0]);
        // The row without a result is left out.
        are(&curves(&svg, ORANGE)[0], &[[0.1, 1.5], [0.4, 1.0]], [0.3, 2.0]);
        let texts: Vec<String> = texts(&svg).into_iter().map(|(text, ..)| text).collect();
        for text in ["h", "−a.uy last [m]", "model = soft", "model = &lt;b&gt;, stiff", "2 of 6 runs are not finished"]
        {
            assert!(texts.iter().any(|other| other == text), "{text}: {texts:?}");
        }
        assert!(!svg.contains("<b>"));
    }
    // Without -o beside the table.
    succeeds(&plot(folder.path(), &["sweep", "--x", "a.uy last", "--y", "a.uy max"]));
    let svg = fs::read_to_string(folder.path().join("sweep/table.svg")).unwrap();
    assert_eq!(svg.matches("<circle").count(), 5, "a circle a row, for the horizontal axis is no parameter");
}

#[test]
fn the_distribution_of_a_sweep_has_its_percentiles() {
    let folder = tempfile::tempdir().unwrap();
    let rows: Vec<String> = (1..=20).map(|i| format!("s{i},{i},finished,1.0,{}", (7 * i) % 20)).collect();
    fs::write(folder.path().join("t.csv"), format!("run,seed,state,time [s],F max [kN]\n{}\n", rows.join("\n")))
        .unwrap();
    let output = plot(folder.path(), &["t.csv", "--y", "F max", "--distribution", "-o", "p.svg"]);
    succeeds(&output);
    // 0 … 19: variance (20² − 1)/12 · 20/19.
    let said = said(&output);
    assert!(said.contains("F max [kN]: 20 runs, mean 9.5, standard deviation 5.91608"), "{said}");
    assert!(said.contains("5 % 0.5, 25 % 4.5, 50 % 9.5, 75 % 14.5, 95 % 18.5"), "{said}");
    let svg = fs::read_to_string(folder.path().join("p.svg")).unwrap();
    let expected: Vec<[f64; 2]> = (0..20).map(|i| [f64::from(i), (f64::from(i) + 0.5) / 20.0]).collect();
    are(&curves(&svg, BLUE)[0], &expected, [19.0, 1.0]);
}

#[test]
fn a_distribution_of_small_values_has_their_digits_and_none_that_is_not_finite() {
    let folder = tempfile::tempdir().unwrap();
    let rows = "a,1,finished,1e-7,2.5,nan\nb,2,finished,3e-7,,inf\nc,3,finished,nan,,nan\nd,4,finished,-inf,inf,nan\n";
    let text = format!("run,seed,state,u last [m],F last [kN],w last [m]\n{rows}");
    fs::write(folder.path().join("t.csv"), text).unwrap();
    let output = plot(folder.path(), &["t.csv", "--y", "u last,F last", "--distribution"]);
    succeeds(&output);
    let told = said(&output);
    let u = "u last [m]: 2 runs, mean 2e-7, standard deviation 1.41421e-7, 2 left out, not finite\n  5 % 1e-7,";
    assert!(told.contains(u), "{told}");
    // One value scatters by nothing that is known.
    assert!(told.contains("F last [kN]: 1 run, mean 2.5, 1 left out, not finite\n"), "{told}");
    assert!(folder.path().join("t.svg").exists(), "a table with a state is that of a sweep");
    let output = plot(folder.path(), &["t.csv", "--y", "w last", "--distribution"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("no row has a number in a column of --y"), "{}", said(&output));
}

#[test]
fn the_picture_of_another_table_is_named_by_the_user() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.csv"), "x,y\n1,2\n2,3\n").unwrap();
    fs::write(folder.path().join("a.svg"), "mine").unwrap();
    let output = plot(folder.path(), &["a.csv", "--x", "x", "--y", "y"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("name the picture with -o"), "{}", said(&output));
    assert_eq!(fs::read_to_string(folder.path().join("a.svg")).unwrap(), "mine");
    succeeds(&plot(folder.path(), &["a.csv", "--x", "x", "--y", "y", "-o", "b.svg"]));
    fs::rename(folder.path().join("a.csv"), folder.path().join("table.csv")).unwrap();
    succeeds(&plot(folder.path(), &["table.csv", "--x", "x", "--y", "y"]));
    assert!(folder.path().join("table.svg").exists());
}

#[test]
fn what_a_table_has_not_is_told_in_one_message() {
    let folder = sweep();
    fs::write(folder.path().join("plain.csv"), "a,b\n1,2\n2,x\n").unwrap();
    fs::write(folder.path().join("torn.csv"), "a,b\n1,2\n2\n").unwrap();
    let listed = said(&plot(folder.path(), &["sweep", "--list"]));
    assert!(listed.contains("6 rows") && listed.contains("h              0.1 … 0.4"), "{listed}");
    assert!(listed.contains("model          texts") && listed.contains("a.uy last [m]  -3 … -1"), "{listed}");
    for (arguments, problem) in [
        (&["sweep", "--y", "state"][..], "the column `state` is not numeric: its row 1 has `finished`"),
        (&["sweep", "--x", "model", "--y", "a.uy max"], "the column `model` is not numeric"),
        (&["sweep", "--y", "a.yu max"], "has no column `a.yu max`; near to it are `a.uy max`"),
        (&["sweep"], "no quantity of the table is chosen"),
        (&["plain.csv", "--x", "a", "--y", "b"], "the column `b` is not numeric: its row 2 has `x`"),
        (&["plain.csv", "--y", "a"], "name the column along the horizontal axis with --x"),
        (&["torn.csv", "--x", "a", "--y", "b"], "torn.csv:3: it is not a table"),
        (&["none.csv", "--x", "a", "--y", "b"], "none.csv"),
        (&["sweep", "plain.csv", "--y", "a"], "a table of a sweep is drawn alone"),
        (&["sweep", "--iterations"], "a table of a sweep is drawn alone"),
    ] {
        let output = plot(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains(problem), "{arguments:?}: {}", said(&output));
        let errors = said(&output).lines().filter(|line| line.starts_with("error: ")).count();
        assert_eq!(errors, 1, "{arguments:?}: {}", said(&output));
    }
    let output = plot(runs().path(), &["a", "--distribution"]);
    assert!(said(&output).contains("a run alone has no distribution"), "{}", said(&output));
}

#[test]
fn hostile_text_stays_text() {
    let folder = runs();
    let title = "</text><script>alert('1')</script>&\"\u{1}";
    let svg = svg(folder.path(), &["a", "--title", title]);
    assert!(!svg.contains("<script") && svg.contains("&lt;script&gt;"));
    well_formed(&folder.path().join("p.svg"));
}

/// Fails unless a file is well-formed XML.
#[track_caller]
pub fn well_formed(path: &Path) {
    let program = "import sys, xml.etree.ElementTree as e; e.parse(sys.argv[1])";
    succeeds(&python().args(["-c", program]).arg(path).output().unwrap());
}
