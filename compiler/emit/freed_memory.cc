#include "compiler/emit/freed_memory.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace plumb::compiler {

void ReturnFreedMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace plumb::compiler
