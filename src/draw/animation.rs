//! Several pictures of one size, one after the other, as a GIF.

use super::{Picture, pixels, undrawn};
use crate::error::Result;
use crate::io::atomic;
use gif::{Encoder, Frame, Repeat};
use std::path::Path;

/// How long a picture is shown, in hundredths of a second; the last one of a series is shown longer.
const SHOWN: u16 = 20;
const LAST: u16 = 150;
/// Time for colours: 1 is best, 30 is fastest (`gif`); a picture has no more than a few thousand.
const SPEED: i32 = 10;

/// Writes `count` pictures, which `picture` makes one by one, as a GIF that begins again when it ends.
///
/// # Errors
/// Those of `picture`; `Machine` when one cannot be drawn, or the file not be written.
pub fn write<P: Picture>(path: &Path, count: usize, mut picture: impl FnMut(usize) -> Result<P>) -> Result<()> {
    let mut encoder = None;
    for i in 0..count {
        let ([width, height], rgb) = pixels(&picture(i)?)?;
        let [width, height] = [width as u16, height as u16];
        let mut frame = Frame::from_rgb_speed(width, height, &rgb, SPEED);
        frame.delay = if i + 1 == count { LAST } else { SHOWN };
        if encoder.is_none() {
            let mut new = Encoder::new(Vec::new(), width, height, &[]).map_err(|e| undrawn(&e))?;
            new.set_repeat(Repeat::Infinite).map_err(|e| undrawn(&e))?;
            encoder = Some(new);
        }
        encoder.as_mut().map_or(Ok(()), |encoder| encoder.write_frame(&frame)).map_err(|e| undrawn(&e))?;
    }
    let bytes = encoder.map_or(Ok(Vec::new()), Encoder::into_inner).map_err(|e| undrawn(&e))?;
    atomic::write(path, |out| out.write_all(&bytes))
}
