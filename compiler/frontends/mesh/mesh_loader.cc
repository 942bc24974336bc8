#include "compiler/frontends/mesh/mesh_loader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <exception>
#include <filesystem>
#include <new>

#include "compiler/frontends/mesh/mesh_origin.h"
#include "compiler/frontends/mesh/mesh_reader.h"

namespace plumb::compiler {
namespace {

enum class Verdict : char { kRead = 'R', kRefused = 'E', kTooLarge = 'L' };

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitMemory = false;  // sanitizers reserve terabytes of addresses
#else
constexpr bool kLimitMemory = true;
#endif

void Limit(int resource, rlim_t soft) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0) return;
  limit.rlim_cur = std::min(soft, limit.rlim_max);
  setrlimit(static_cast<__rlimit_resource_t>(resource), &limit);
}

void WriteAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    bytes.remove_prefix(static_cast<size_t>(n));
  }
}

const char* HintOf(SourceFormat format) {
  switch (format) {
    case SourceFormat::kObj: return "obj";
    case SourceFormat::kPly: return "ply";
    case SourceFormat::kStl: return "stl";
    case SourceFormat::kCollada: return "dae";
    case SourceFormat::kGltf: return "glb";
    case SourceFormat::kGltfJson: return "gltf";
    default: return "";
  }
}

// Never returns: whatever assimp leaves behind ends with the process.
[[noreturn]] void RunChild(int fd, std::string_view bytes, const Source& source, const MeshOptions& options) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGTERM, SIGINT}) std::signal(signal, SIG_DFL);
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_CPU, static_cast<rlim_t>(options.reader_time_s) + 1);
  if (kLimitMemory) Limit(RLIMIT_AS, options.reader_memory_bytes);
  if (const int null = open("/dev/null", O_WRONLY); null >= 0) {
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
  }
  std::string answer;
  try {
    const std::string folder = std::filesystem::path(source.path).parent_path().string();
    const auto objects = ReadWithAssimp(bytes, HintOf(source.format), folder, options.max_triangles);
    if (objects) {
      answer = static_cast<char>(Verdict::kRead) + EncodeObjects(*objects);
    } else {
      const bool large = objects.error().code == ErrorCode::kFileTooLarge;
      answer = static_cast<char>(large ? Verdict::kTooLarge : Verdict::kRefused) + objects.error().message;
    }
  } catch (const std::bad_alloc&) {
    answer = static_cast<char>(Verdict::kTooLarge) + std::string("it needs more memory than a mesh is given");
  } catch (const std::exception& e) {
    answer = static_cast<char>(Verdict::kRefused) + std::string(e.what());
  }
  WriteAll(fd, answer);
  _exit(0);
}

// Until the child closes its end; false: not in time, or more than a mesh can be.
bool ReadAll(int fd, const MeshOptions& options, std::string& out) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(options.reader_time_s);
  std::vector<char> buffer(size_t{1} << 16);
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0 || out.size() > options.reader_memory_bytes) return false;
    pollfd ready{fd, POLLIN, 0};
    const int n_ready = poll(&ready, 1, static_cast<int>(left));
    if (n_ready < 0 && errno == EINTR) continue;
    if (n_ready <= 0) return false;
    const ssize_t n = read(fd, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n == 0;
    out.append(buffer.data(), static_cast<size_t>(n));
  }
}

Expected<std::string> RunReader(std::string_view bytes, const Source& source, const MeshOptions& options) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return Fail(ErrorCode::kInternal, "no pipe to the mesh reader");
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    return Fail(ErrorCode::kInternal, "no process for the mesh reader");
  }
  if (child == 0) {
    close(ends[0]);
    RunChild(ends[1], bytes, source, options);
  }
  close(ends[1]);
  std::string answer;
  const bool in_time = ReadAll(ends[0], options, answer);
  close(ends[0]);
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!in_time) return Fail(ErrorCode::kFileTooLarge, fmt::format("reading it took more than {:.0f} s", options.reader_time_s));
  if (WIFSIGNALED(status)) {
    return Fail(ErrorCode::kFileUnreadable, fmt::format("the mesh reader ended with signal {} on it", WTERMSIG(status)));
  }
  if (answer.empty()) return Fail(ErrorCode::kFileUnreadable, "the mesh reader gave no answer");
  return answer;
}

}  // namespace

Expected<MeshScene> LoadMesh(const Source& source, const MeshOptions& options) {
  MeshScene scene;
  const std::optional<std::string> near_zero = source.format == SourceFormat::kObj ? ObjNearZero(source.bytes, scene.origin) : std::nullopt;
  Expected<std::string> answer = RunReader(near_zero ? std::string_view(*near_zero) : source.bytes, source, options);
  if (!answer) return tl::unexpected(answer.error());
  const std::string_view content = std::string_view(*answer).substr(1);
  switch (static_cast<Verdict>((*answer)[0])) {
    case Verdict::kRead: break;
    case Verdict::kTooLarge: return Fail(ErrorCode::kFileTooLarge, std::string(content));
    default: return Fail(ErrorCode::kFileUnreadable, std::string(content));
  }
  Expected<std::vector<MeshObject>> objects = DecodeObjects(content);
  if (!objects) return tl::unexpected(objects.error());
  scene.objects = std::move(*objects);
  for (MeshObject& o : scene.objects) {
    o.location.guid = o.name;
    o.location.type = "mesh object";
  }
  // The reader turns what these formats state into metres, y up.
  if (source.format == SourceFormat::kCollada || source.format == SourceFormat::kGltf || source.format == SourceFormat::kGltfJson) {
    scene.unit_m = 1;
    scene.up = UpAxis::kY;
  }
  return scene;
}

}  // namespace plumb::compiler
