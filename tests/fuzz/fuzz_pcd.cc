// Any bytes as a scan file: an error or a scan, never a crash nor an allocation far above the file's size.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <string>

#include "runtime/sources/recording.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const int fd = memfd_create("scan", 0);
  if (fd < 0) return 0;
  if (write(fd, data, size) == static_cast<ssize_t>(size)) (void)plumb::runtime::ReadPcd("/proc/self/fd/" + std::to_string(fd), 0.0);
  close(fd);
  return 0;
}
