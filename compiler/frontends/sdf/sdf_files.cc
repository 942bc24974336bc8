#include "compiler/frontends/sdf/sdf_files.h"

#include <algorithm>

namespace plumb::compiler {
namespace fs = std::filesystem;

ModelFiles::ModelFiles(const fs::path& world, const std::vector<std::string>& model_path) {
  std::error_code ignored;
  const auto add = [&](const fs::path& folder) { roots_.push_back(fs::weakly_canonical(folder.empty() ? "." : folder, ignored)); };
  add(world.parent_path());
  for (const std::string& folder : model_path) {
    if (!folder.empty()) add(folder);
  }
}

bool ModelFiles::IsWithinRoots(const fs::path& path) const {
  return std::any_of(roots_.begin(), roots_.end(), [&](const fs::path& root) {
    return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
  });
}

FoundFile ModelFiles::Find(const std::string& uri, const fs::path& folder) const {
  std::string name = uri;
  bool in_models = false;
  for (const char* scheme : {"model://", "package://", "file://"}) {
    if (!name.starts_with(scheme)) continue;
    name.erase(0, std::string(scheme).size());
    in_models = scheme[0] != 'f';
  }
  if (name.empty() || name.find("://") != std::string::npos) return {std::nullopt, UriFault::kOutside};
  std::vector<fs::path> candidates;
  if (!in_models) candidates.push_back(folder / name);
  for (const fs::path& root : roots_) {
    candidates.push_back(root / name);
    if (in_models) candidates.push_back(root / "models" / name);
  }
  bool outside = false;
  for (const fs::path& candidate : candidates) {
    std::error_code error;
    const fs::path path = fs::weakly_canonical(candidate, error);
    if (error) continue;
    if (!IsWithinRoots(path)) {
      outside = true;
      continue;
    }
    if (fs::exists(path, error)) return {path, UriFault::kNone};
  }
  return {std::nullopt, outside ? UriFault::kOutside : UriFault::kMissing};
}

}  // namespace plumb::compiler
