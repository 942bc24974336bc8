// Independent jobs on all cores; what they find must not depend on their order.
#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>

namespace plumb::compiler {

// Calls job(i) for i < jobs, on several threads if there are `min_parallel` or more: to start them takes half a megabyte and a millisecond.
template <class Job>
void ForEachJob(size_t jobs, size_t min_parallel, const Job& job) {
  if (jobs >= min_parallel) {
    tbb::parallel_for(size_t{0}, jobs, job);
  } else {
    for (size_t i = 0; i < jobs; ++i) job(i);
  }
}

}  // namespace plumb::compiler
