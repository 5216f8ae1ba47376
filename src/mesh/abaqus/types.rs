//! The types of elements: those of the plane and of rotational symmetry, membranes and shells, in all their formulations.

use crate::mesh::shape::CellKind;

/// What an element is.
pub enum Type {
    Plane(CellKind),
    /// Along a curve.
    Line(CellKind),
    Solid,
    /// A spring, a beam, a mass, …
    Other,
}

/// The type of an element by its name, such as `CPE8R`.
pub fn type_of(name: &str) -> Type {
    let name = name.to_uppercase();
    let of = |families: &[&str]| {
        let rest = families.iter().find_map(|family| name.strip_prefix(family))?;
        let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
        // A family is followed by the number of nodes, and that by letters for the formulation.
        let plain = rest[digits..].bytes().all(|c| c.is_ascii_alphabetic());
        rest[..digits].parse::<u32>().ok().filter(|_| plain)
    };
    let plane = ["CPEG", "CPE", "CPS", "CGAX", "CAX", "M3D", "STRI", "DS", "S"];
    match of(&plane) {
        Some(3) => return Type::Plane(CellKind::T3),
        Some(4) => return Type::Plane(CellKind::Q4),
        Some(6 | 65) => return Type::Plane(CellKind::T6),
        Some(8) => return Type::Plane(CellKind::Q8),
        Some(9) => return Type::Plane(CellKind::Q9),
        _ => {}
    }
    if of(&["C3D", "DC3D", "SC"]).is_some() {
        return Type::Solid;
    }
    // What Gmsh makes of the lines of its groups.
    match name.as_str() {
        "T3D2" => Type::Line(CellKind::Line2),
        "T3D3" => Type::Line(CellKind::Line3),
        _ => Type::Other,
    }
}
