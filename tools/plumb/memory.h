// What the allocator does with memory that a run has given back.
#pragma once

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace plumb::tools {

// A solve of everything takes tens of megabytes in large blocks and gives them back. By default glibc, once it has seen such blocks, keeps
// them on its heap, between what stays: after an hour that is a third of the process. To be called once, before threads are started.
inline void ReturnLargeBlocks() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 256 * 1024);
  mallopt(M_TRIM_THRESHOLD, 1024 * 1024);
#endif
}

}  // namespace plumb::tools
