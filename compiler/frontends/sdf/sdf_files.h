// Which files a world may name, and where they are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumb::compiler {

enum class UriFault : uint8_t { kNone, kMissing, kOutside };

struct FoundFile {
  std::optional<std::filesystem::path> path;
  UriFault fault = UriFault::kNone;
};

// Resolves `model://NAME/rest`, `package://`, `file://` and plain paths against `folder` (of the document that names it) and the roots.
// Links are followed before it is judged whether a file lies within a root.
class ModelFiles {
 public:
  ModelFiles(const std::filesystem::path& world, const std::vector<std::string>& model_path);
  [[nodiscard]] FoundFile Find(const std::string& uri, const std::filesystem::path& folder) const;

 private:
  [[nodiscard]] bool IsWithinRoots(const std::filesystem::path& path) const;
  std::vector<std::filesystem::path> roots_;  // the world's folder first
};

}  // namespace plumb::compiler
