//! Slow work off the critical path: jobs run one after the other, in order, on a thread of their own.
//!
//! Order is the point: a checkpoint handed over after a frame is on the disk after it, so a run that is killed
//! never continues from behind a frame that was lost. After a job fails the later ones are dropped and the
//! error is reported at the next call.

use std::sync::mpsc::{SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, JoinHandle};

use crate::error::{Error, Result};

type Job = Box<dyn FnOnce() -> Result<()> + Send>;

/// A queue of jobs and the thread that works through it. Dropping it waits for the jobs, and hides their
/// error: end with [`Background::close`].
pub struct Background {
    sender: Option<SyncSender<Job>>,
    thread: Option<JoinHandle<()>>,
    failure: Arc<Mutex<Option<Error>>>,
}

impl Background {
    /// Starts the thread; at most `waiting` jobs wait, then [`Background::submit`] does.
    ///
    /// # Errors
    /// `Machine` when no thread can be started.
    pub fn start(waiting: usize) -> Result<Self> {
        let (sender, receiver) = sync_channel::<Job>(waiting);
        let failure = Arc::new(Mutex::new(None));
        let shared = Arc::clone(&failure);
        let work = move || {
            for job in receiver {
                if lock(&shared).is_none()
                    && let Err(e) = job()
                {
                    *lock(&shared) = Some(e);
                }
            }
        };
        let thread = Builder::new().name("writer".to_string()).spawn(work).map_err(|e| {
            Error::machine("output", format!("no thread can be started: {e}"), "end other programs and try again")
        })?;
        Ok(Self { sender: Some(sender), thread: Some(thread), failure })
    }

    /// Hands over a job; waits while the queue is full.
    ///
    /// # Errors
    /// That of an earlier job, if one failed; then `job` is dropped.
    pub fn submit(&self, job: impl FnOnce() -> Result<()> + Send + 'static) -> Result<()> {
        self.check()?;
        match self.sender.as_ref().map(|sender| sender.send(Box::new(job))) {
            Some(Ok(())) => Ok(()),
            _ => Err(stopped()),
        }
    }

    /// Waits until all jobs are done.
    ///
    /// # Errors
    /// That of the first job that failed.
    pub fn flush(&self) -> Result<()> {
        let (done, wait) = sync_channel(1);
        self.submit(move || {
            // Nobody waits any more only when the caller is gone.
            let _ = done.send(());
            Ok(())
        })?;
        // A dropped job ends the wait with an error, too; the failure says more.
        let waited = wait.recv();
        self.check()?;
        waited.map_err(|_| stopped())
    }

    /// Waits until all jobs are done and ends the thread.
    ///
    /// # Errors
    /// That of the first job that failed.
    pub fn close(mut self) -> Result<()> {
        let ended = self.join();
        self.check()?;
        ended
    }

    fn join(&mut self) -> Result<()> {
        drop(self.sender.take());
        match self.thread.take().map(JoinHandle::join) {
            Some(Err(_)) => Err(stopped()),
            _ => Ok(()),
        }
    }

    fn check(&self) -> Result<()> {
        lock(&self.failure).clone().map_or(Ok(()), Err)
    }
}

impl Drop for Background {
    fn drop(&mut self) {
        // `close` reports; here the files only need to be complete.
        let _ = self.join();
    }
}

/// The value is whole even if its owner died.
fn lock(failure: &Mutex<Option<Error>>) -> MutexGuard<'_, Option<Error>> {
    failure.lock().unwrap_or_else(PoisonError::into_inner)
}

fn stopped() -> Error {
    Error::analysis("output", "the thread that writes the files stopped", "report this as a mistake of mpm")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recording(log: &Arc<Mutex<Vec<usize>>>, i: usize) -> impl FnOnce() -> Result<()> + Send + 'static {
        let log = Arc::clone(log);
        move || {
            std::thread::sleep(std::time::Duration::from_millis(2));
            log.lock().unwrap().push(i);
            Ok(())
        }
    }

    #[test]
    fn jobs_run_in_order_and_drop_waits_for_them() {
        let log = Arc::new(Mutex::new(Vec::new()));
        let background = Background::start(2).unwrap();
        for i in 0..10 {
            background.submit(recording(&log, i)).unwrap();
        }
        background.flush().unwrap();
        assert_eq!(*log.lock().unwrap(), (0..10).collect::<Vec<_>>());
        background.submit(recording(&log, 10)).unwrap();
        drop(background);
        assert_eq!(log.lock().unwrap().len(), 11);
    }

    #[test]
    fn a_failure_is_reported_and_later_jobs_are_dropped() {
        let log = Arc::new(Mutex::new(Vec::new()));
        let background = Background::start(4).unwrap();
        background.submit(recording(&log, 0)).unwrap();
        background.submit(|| Err(Error::machine("frame-000001.mpmf", "disk full", "free some"))).unwrap();
        // Accepted or refused, depending on who is faster; done in no case.
        let _ = background.submit(recording(&log, 1));
        assert_eq!(background.flush().unwrap_err().place, "frame-000001.mpmf");
        assert_eq!(background.submit(recording(&log, 2)).unwrap_err().place, "frame-000001.mpmf");
        assert_eq!(background.close().unwrap_err().place, "frame-000001.mpmf");
        assert_eq!(*log.lock().unwrap(), [0]);
    }

    #[test]
    fn a_job_that_panics_is_an_error_not_a_hang() {
        let background = Background::start(1).unwrap();
        background.submit(|| panic!("on purpose")).unwrap();
        assert!(background.flush().is_err());
        assert!(background.close().is_err());
    }
}
