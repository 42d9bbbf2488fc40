//! Memory that is used again in every step of training. Fresh memory must be cleared by the
//! operating system page by page, which takes about as long as the arithmetic in between.

use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::nn::element::Element;

/// Buffers that wait at most; what comes back beyond them is given up.
const MAX_WAITING: usize = 64;

/// Buffers of one layer or stack, which all its copies share.
#[derive(Debug, Clone, Default)]
pub(crate) struct Workspace {
    pub(crate) f32: Pool<f32>,
    pub(crate) f64: Pool<f64>,
}

/// Buffers that wait for their next use.
#[derive(Debug, Clone, Default)]
pub(crate) struct Pool<T>(Arc<Mutex<Vec<Vec<T>>>>);

/// Numbers that go back to where they came from when they are dropped.
#[derive(Debug)]
pub(crate) struct Buffer<T: Element> {
    values: Vec<T>,
    pool: Pool<T>,
}

impl<T> Pool<T> {
    /// What waits. A panic elsewhere leaves nothing half done here.
    fn waiting(&self) -> MutexGuard<'_, Vec<Vec<T>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T: Element> Buffer<T> {
    /// `len` numbers of any value.
    pub(crate) fn take(workspace: &Workspace, len: usize) -> Self {
        let pool = T::pool(workspace).clone();
        let found = {
            let mut waiting = pool.waiting();
            let fits = waiting.iter().enumerate().filter(|(_, values)| values.capacity() >= len);
            let smallest = fits.min_by_key(|(_, values)| values.capacity()).map(|(i, _)| i);
            smallest.map(|i| waiting.swap_remove(i))
        };
        let mut values = found.unwrap_or_default();
        values.resize(len, T::ZERO);
        Self { values, pool }
    }

    /// `len` zeros.
    pub(crate) fn zeros(workspace: &Workspace, len: usize) -> Self {
        let mut buffer = Self::take(workspace, len);
        buffer.fill(T::ZERO);
        buffer
    }
}

impl<T: Element> Drop for Buffer<T> {
    fn drop(&mut self) {
        let mut waiting = self.pool.waiting();
        if waiting.len() < MAX_WAITING {
            waiting.push(std::mem::take(&mut self.values));
        }
    }
}

impl<T: Element> Deref for Buffer<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.values
    }
}

impl<T: Element> DerefMut for Buffer<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_buffer_is_used_again_if_it_is_long_enough() {
        let workspace = Workspace::default();
        let (small, large) =
            (Buffer::<f32>::zeros(&workspace, 10), Buffer::<f32>::zeros(&workspace, 100));
        let (small_at, large_at) = (small.as_ptr(), large.as_ptr());
        drop((small, large));
        let (first, second) = (Buffer::<f32>::take(&workspace, 8), Buffer::take(&workspace, 9));
        assert_eq!((first.as_ptr(), first.len()), (small_at, 8));
        assert_eq!((second.as_ptr(), second.len()), (large_at, 9));
        assert_eq!(&*Buffer::<f64>::zeros(&workspace, 2), [0.0; 2]);
    }

    #[test]
    fn what_waits_is_limited() {
        let workspace = Workspace::default();
        let all: Vec<Buffer<f32>> = (0..100).map(|_| Buffer::zeros(&workspace, 1)).collect();
        drop(all);
        assert_eq!(workspace.f32.waiting().len(), MAX_WAITING);
    }
}
