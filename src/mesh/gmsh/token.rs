//! The words of a script of Gmsh.

/// A word of the language, where it begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'a> {
    pub kind: Kind<'a>,
    pub line: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind<'a> {
    Word(&'a [u8]),
    Text(&'a [u8]),
    Number(&'a [u8]),
    Symbol(u8),
}
