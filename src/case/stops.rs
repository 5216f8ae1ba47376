//! When the steps of a phase must end.

use crate::step::Stop;

/// When steps must end: at outputs, where a table bends, and at the end of the phase.
pub fn of(duration: f64, every: Option<f64>, kinks: impl Iterator<Item = f64>) -> Vec<Stop> {
    let tiny = 1e-9 * duration;
    let mut stops = vec![Stop { time: duration, frame: true }];
    if let Some(every) = every {
        let count = ((duration - tiny) / every).floor() as usize;
        stops.extend((1..=count).map(|k| Stop { time: k as f64 * every, frame: true }));
    }
    let kinks = kinks.filter(|&t| t > tiny && t < duration - tiny);
    stops.extend(kinks.map(|time| Stop { time, frame: false }));
    stops.sort_by(|a, b| a.time.total_cmp(&b.time));
    // Of stops at a time one is enough, with a frame if one of them has.
    stops.dedup_by(|later, kept| {
        let same = later.time - kept.time <= tiny && !(later.frame && kept.frame);
        if same && later.frame {
            (kept.time, kept.frame) = (later.time, true);
        }
        same
    });
    stops
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_stop_at_outputs_kinks_and_the_end() {
        let stops = of(1.0, Some(0.3), [0.0, 0.45, 0.6, 1.0].into_iter());
        let expected = [(0.3, true), (0.45, false), (0.6, true), (0.9, true), (1.0, true)];
        assert_eq!(stops.len(), expected.len());
        for (stop, (time, frame)) in stops.iter().zip(expected) {
            assert!((stop.time - time).abs() < 1e-12 && stop.frame == frame, "{stop:?}");
        }
    }

    #[test]
    fn an_output_interval_that_divides_the_duration_adds_no_sliver() {
        assert_eq!(of(1.0, Some(0.1), std::iter::empty()).len(), 10);
    }
}
