use super::*;
use crate::draw::{png, svg};
use crate::io::vtu::Grid;
use crate::io::vtu::Topology;

fn grid(points: &[[f64; 2]], cells: &[[i64; 3]], region: u16, arrays: Vec<Array>) -> Grid {
    Grid {
        points: points.iter().flat_map(|x| [x[0], x[1], 0.0]).collect(),
        topology: Topology {
            connectivity: cells.concat(),
            offsets: (1..=cells.len() as i64).map(|c| 3 * c).collect(),
            types: vec![5; cells.len()],
        },
        point_data: arrays,
        cell_data: vec![Array { name: "region [-]".into(), components: 1, data: Data::U16(vec![region; cells.len()]) }],
        ..Grid::default()
    }
}

fn array(name: &str, components: usize, values: Vec<f64>) -> Array {
    Array { name: name.into(), components, data: Data::F64(values) }
}

/// Points of the block with a displacement to the right, uniaxial compression of the left half and tension of the right one, and one point at yield.
fn points() -> Grid {
    let places: Vec<[f64; 2]> =
        (0..32).map(|i| [0.25 + 0.5 * f64::from(i % 8), 0.25 + 0.5 * f64::from(i / 8)]).collect();
    let stress = |x: &[f64; 2]| if x[0] < 2.0 { -30.0 } else { 10.0 };
    let stresses = places.iter().flat_map(|x| [0.0, stress(x), 0.0, 0.0, 0.0, 0.0]).collect();
    let mut plastic = vec![0.0; 32];
    (plastic[5], plastic[9]) = (1.0, 2.0);
    let fields = vec![
        array("displacement [m]", 3, [0.2, 0.0, 0.0].repeat(32)),
        array("stress [kPa]", 6, stresses),
        array("plastic_points [-]", 1, plastic),
    ];
    grid(&places, &[], 0, fields)
}

/// A block of soil of 4 by 2 with a structure of 1 by 1 on it, and stress `σ_yy = y`.
fn shown() -> Shown {
    let block = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]];
    let above = [[1.0, 2.0], [2.0, 2.0], [2.0, 3.0], [1.0, 3.0]];
    let cells = [[0, 1, 2], [0, 2, 3]];
    let stress = block.iter().flat_map(|x| [0.0, x[1], 0.0, 0.0, 0.0, 0.0]).collect();
    let way = block.iter().flat_map(|x| [3.0 * x[0], 4.0 * x[0], 0.0]).collect();
    let fields = vec![
        array("stress [kPa]", 6, stress),
        array("displacement [m]", 3, way),
        array("plastic_strain [-]", 1, vec![0.0; 4]),
    ];
    Shown {
        points: points(),
        grid: grid(&block, &cells, 0, Vec::new()),
        soil: Some(grid(&block, &cells, 0, fields)),
        structures: Some(grid(&above, &cells, 1, Vec::new())),
        contact: None,
        surface: None,
        plates: None,
        sections: Vec::new(),
    }
}

fn field(name: &str, options: Options) -> Result<Field> {
    Field::of(&shown(), &[true, false], &Asked::of(name), "A block, t = 1 s".into(), options)
}

/// The part of the window that soil and structures cover.
fn covered(field: &Field) -> [f64; 2] {
    let (mut raster, paper) = (field.painted(crate::draw::PIXELS), field.paper());
    raster.within([LEFT, paper.above], [LEFT + paper.size[0], paper.above + paper.size[1]]);
    [raster.part(|of| of > 0 && of < STRUCTURES), raster.part(|of| of >= STRUCTURES)]
}

#[test]
fn what_is_seen_covers_its_area_and_its_place() {
    for width in [600, 1600] {
        let options = Options { width: Some(width), ..Options::default() };
        let field = field("stress.yy", options).unwrap();
        // The window is the box with its margin.
        let window = (4.0 + 8.0 * MARGIN) * (3.0 + 8.0 * MARGIN);
        let [soil, structure] = covered(&field);
        assert!((soil * window / 8.0 - 1.0).abs() < 0.01, "{soil}");
        assert!((structure * window - 1.0).abs() < 0.01, "{structure}");
        let (raster, paper) = (field.painted(1), field.paper());
        let at = |x, y| raster.shown(paper.at([x, y]));
        let inside = [[1.01, 2.02], [1.5, 2.5], [1.98, 2.98]].map(|[x, y]| at(x, y));
        assert_eq!(inside, [STRUCTURES + 1; 3]);
        assert_eq!([at(0.02, 0.02), at(3.98, 1.98), at(3.0, 2.05), at(0.95, 2.5)], [1, 1, 0, 0]);
        let ([w, h], pixels) = crate::draw::pixels(&field).unwrap();
        assert!(w == width && pixels.len() == (3 * w * h) as usize);
        // Dark below, light above, as viridis is.
        let pixel = |x: f64, y: f64| {
            let at = paper.at([x, y]).map(|p| (p * f64::from(crate::draw::PIXELS)) as usize);
            let first = 3 * (at[1] * w as usize + at[0]);
            [pixels[first], pixels[first + 1], pixels[first + 2]]
        };
        for (y, t) in [(0.1, 0.05), (1.0, 0.5), (1.9, 0.95)] {
            let (found, wanted) = (pixel(3.0, y), Map::Viridis.at(t));
            assert!((0..3).all(|k| found[k].abs_diff(wanted[k]) < 6), "{y}: {found:?} {wanted:?}");
        }
        assert_eq!(pixel(1.5, 2.4), STRUCTURE);
    }
}

#[test]
fn components_sizes_and_mistakes() {
    let of = |name: &str| field(name, Options::default());
    assert_eq!(of("stress.yy").unwrap().extent(), Some([0.0, 2.0]));
    assert_eq!(of("stress.yy").unwrap().name, "stress.yy [kPa]");
    assert_eq!(of("displacement").unwrap().extent(), Some([0.0, 20.0]));
    assert_eq!(of("displacement.x").unwrap().extent(), Some([0.0, 12.0]));
    // A field that is zero all over is drawn.
    let zero = of("plastic_strain").unwrap();
    assert!(zero.name == "plastic_strain" && zero.range()[0] < zero.range()[1]);
    assert!(of("stress").unwrap_err().remedy.contains("stress.xx, stress.yy"));
    assert!(of("stress.rr").unwrap_err().problem.contains("`rr`"));
    assert!(of("plastic_strain.x").unwrap_err().remedy.contains("number"));
    assert!(of("velocity").unwrap_err().remedy.contains("stress, displacement, plastic_strain"));
    assert!(
        field("stress.yy", Options { contact: true, ..Options::default() }).unwrap_err().problem.contains("no contact")
    );
}

#[test]
fn a_range_with_both_signs_is_about_zero_and_a_window_cuts() {
    let options = Options { range: Some([-1.0, 3.0]), window: Some([3.0, 1.0, 4.0, 2.0]), ..Options::default() };
    let field = field("stress.yy", options).unwrap();
    assert_eq!(field.scale(), (Map::Diverging, [-3.0, 3.0]));
    assert_eq!(covered(&field), [1.0, 0.0]);
}

#[test]
fn the_other_half_is_a_mirror() {
    let one = field("stress.yy", Options::default()).unwrap();
    let both = field("stress.yy", Options { mirror: true, axisymmetric: true, ..Options::default() }).unwrap();
    assert_eq!((one.bounds(), both.bounds()), ([0.0, 0.0, 4.0, 3.0], [-4.0, 0.0, 4.0, 3.0]));
    let (raster, paper) = (both.painted(1), both.paper());
    let at = |x, y| raster.shown(paper.at([x, y]));
    assert_eq!([at(-1.5, 2.5), at(1.5, 2.5), at(-3.5, 1.0), at(-3.5, 2.5)], [STRUCTURES + 1, STRUCTURES + 1, 1, 0]);
}

#[test]
fn an_svg_has_the_pixels_within_and_its_text_as_text() {
    let field = field("stress.yy", Options { mesh: true, width: Some(600), ..Options::default() }).unwrap();
    let text = svg(&field).unwrap();
    let (background, image, title) = (text.find("<rect"), text.find("<image"), text.find("A block, t = 1 s"));
    assert!(background < image && image < title && title.is_some(), "{background:?} {image:?} {title:?}");
    assert!(text.contains("stress.yy [kPa]") && text.contains("x [m]"));
    assert_eq!(png(&field).unwrap()[..8], [137, 80, 78, 71, 13, 10, 26, 10]);
}

#[test]
fn an_animation_has_all_frames() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("all.gif");
    let options = Options { width: Some(400), ..Options::default() };
    crate::draw::animation::write(&path, 3, |_| field("stress.yy", options.clone())).unwrap();
    let mut decoder = gif::DecodeOptions::new().read_info(std::fs::File::open(&path).unwrap()).unwrap();
    let mut frames = 0;
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        assert_eq!(frame.width, 400);
        frames += 1;
    }
    assert_eq!(frames, 3);
}

#[test]
fn no_title_is_cut_or_lies_on_another() {
    let title = "A block with a title that is so long that it has to be broken into lines, and then once more, phase push, t = 1 s";
    for width in [400, 1600] {
        let options = Options { width: Some(width), ..Options::default() };
        let field =
            Field::of(&shown(), &[true, false], &Asked::of("displacement.x"), title.to_owned(), options).unwrap();
        let lines = field.lines();
        assert_eq!(lines.join(" "), title);
        let room = f64::from(width) / 2.0 - LEFT - 6.0;
        assert!(lines.iter().all(|line| crate::draw::width(line, TITLE) <= room), "{lines:?}");
        assert_eq!(field.paper().above, ABOVE + LINE * lines.len() as f64);
    }
    assert_eq!(field("stress.yy", Options::default()).unwrap().title_lines(), 1);
}

#[test]
fn arrows_crosses_and_points_that_yield_have_a_legend() {
    let options = Options {
        arrows: Some("displacement".into()),
        crosses: true,
        plastic_points: true,
        width: Some(800),
        ..Options::default()
    };
    let needed: Vec<String> = options.needs().collect();
    assert_eq!(needed, ["displacement", "stress", "plastic_points"]);
    let overlaid = field("stress.yy", options).unwrap();
    let text = svg(&overlaid).unwrap();
    for legend in ["displacement 0.2 m", "compression 20 kPa", "tension 20 kPa", "at yield", "at a limit of tension"] {
        assert!(text.contains(legend), "{legend}: {text}");
    }
    let plain = field("stress.yy", Options { width: Some(800), ..Options::default() }).unwrap();
    assert!(!svg(&plain).unwrap().contains("at yield"));
    assert_eq!(overlaid.size()[1] - plain.size()[1], LEGEND as u32);
    // The pixel of the point at yield, seen from both sides.
    let colour = |field: &Field, x: [f64; 2]| {
        let ([w, _], pixels) = crate::draw::pixels(field).unwrap();
        let at = field.paper().at(x).map(|p| (p * f64::from(crate::draw::PIXELS)) as usize);
        let first = 3 * (at[1] * w as usize + at[0]);
        [pixels[first], pixels[first + 1], pixels[first + 2]]
    };
    let alone = Options { plastic_points: true, mirror: true, width: Some(800), ..Options::default() };
    let alone = field("stress.yy", alone).unwrap();
    assert_eq!([2.75, -2.75].map(|x| colour(&alone, [x, 0.25])), [[200, 30, 30]; 2]);
    assert_eq!(colour(&alone, [0.75, 0.75]), [255, 255, 255]);
}

#[test]
fn contours_and_a_net_are_dark_and_regions_are_hidden() {
    let dark = |options: Options| {
        let field = field("stress.yy", Options { width: Some(800), ..options }).unwrap();
        let (raster, paper) = (field.painted(2), field.paper());
        let pixels = raster.pixels();
        let width = field.size()[0] as usize * 2;
        let [x, y] = paper.at([0.02, 2.0]).map(|v| (2.0 * v) as usize);
        let rows = y..paper.at([0.02, 0.0]).map(|v| (2.0 * v) as usize)[1];
        let at =
            |row: usize| usize::from(pixels[3 * (row * width + x)]) + usize::from(pixels[3 * (row * width + x) + 1]);
        // Going down a column of pixels, lines are where it gets much darker.
        rows.collect::<Vec<_>>().windows(4).filter(|rows| at(rows[0]) > at(rows[3]) + 60).count()
    };
    let plain = dark(Options::default());
    assert!(dark(Options { contours: true, ..Options::default() }) > plain);
    assert!(dark(Options { net: Some(0.25), ..Options::default() }) > plain);
    let hidden = field("stress.yy", Options { hidden: vec![1], ..Options::default() }).unwrap();
    assert_eq!(hidden.bounds(), [0.0, 0.0, 4.0, 2.0]);
}
