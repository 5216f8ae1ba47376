//! What a checkpoint keeps of the other files of its run.

use super::foreign::foreign;
use crate::error::Result;
use crate::io::container::Store;
use crate::io::history::Mark;

/// What a checkpoint knows of the other files of its run.
pub struct Written {
    pub history: Mark,
    pub energy: Mark,
    pub log: Mark,
    /// The hashes of the frames.
    pub frames: Vec<u64>,
}

impl Written {
    pub fn put(&self, store: &mut Store) {
        for (name, mark) in [("files.history", self.history), ("files.energy", self.energy), ("files.log", self.log)] {
            store.put(name, 2, vec![mark.lines, mark.hash]);
        }
        store.put("files.frames", 1, self.frames.clone());
    }

    pub fn take(store: &mut Store) -> Result<Self> {
        let mut mark = |name: &str| match store.take::<u64>(name, 2)?[..] {
            [lines, hash] => Ok(Mark { lines, hash }),
            _ => Err(foreign(name)),
        };
        let [history, energy, log] = ["files.history", "files.energy", "files.log"].map(&mut mark);
        Ok(Self { history: history?, energy: energy?, log: log?, frames: store.take("files.frames", 1)? })
    }
}
