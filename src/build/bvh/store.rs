//! The trees' memory: rows of eight lanes, on huge pages where the system gives them.
//!
//! A large tree is read at random, so that with pages of 4 KiB nearly every node misses the
//! translation buffer too. Memory that is mapped apart can be asked to lie on pages of 2 MiB; it
//! comes zeroed. Small trees, and machines where mapping fails, use the heap.

use memmap2::MmapMut;
use pulp::bytemuck::{self, Pod};

/// From this size on, memory is mapped: less does not fill a huge page.
const MAPPED: usize = 4 << 20;

/// An array of blocks of rows.
#[derive(Debug)]
pub struct Store<T>(Memory<T>);

#[derive(Debug)]
enum Memory<T> {
    Heap(Vec<T>),
    Mapped(MmapMut),
}

impl<T: Pod> Store<T> {
    /// `len` blocks of zeros.
    pub fn zeroed(len: usize) -> Self {
        let bytes = len * size_of::<T>();
        let mapped = if bytes < MAPPED { None } else { MmapMut::map_anon(bytes).ok() };
        let Some(map) = mapped else { return Store(Memory::Heap(vec![T::zeroed(); len])) };
        // Advice only: the memory is as good without it.
        #[cfg(target_os = "linux")]
        let _ = map.advise(memmap2::Advice::HugePage);
        Store(Memory::Mapped(map))
    }

    #[inline(always)]
    pub fn blocks(&self) -> &[T] {
        match &self.0 {
            Memory::Heap(blocks) => blocks,
            Memory::Mapped(map) => bytemuck::cast_slice(map),
        }
    }

    pub fn blocks_mut(&mut self) -> &mut [T] {
        match &mut self.0 {
            Memory::Heap(blocks) => blocks,
            Memory::Mapped(map) => bytemuck::cast_slice_mut(map),
        }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.blocks())
    }
}

impl<T: Pod> Clone for Store<T> {
    fn clone(&self) -> Self {
        let mut copy = Store::zeroed(self.blocks().len());
        copy.blocks_mut().copy_from_slice(self.blocks());
        copy
    }
}
