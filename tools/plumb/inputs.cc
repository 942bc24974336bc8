#include "tools/plumb/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "tools/run/run_info.h"

namespace plumb::tools {
namespace {

namespace fs = std::filesystem;

bool HasExtension(const fs::path& path, const auto& extensions) {
  std::string own = path.extension().string();
  std::transform(own.begin(), own.end(), own.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(extensions.begin(), extensions.end(), own) != extensions.end();
}

InputKind KindOfFile(const fs::path& path) {
  std::array<char, 12> head{};
  std::ifstream(path, std::ios::binary).read(head.data(), head.size());
  const std::string_view bytes(head.data(), head.size());
  if (bytes.substr(4, 4) == "PLAG") return InputKind::kAGraph;
  constexpr std::array<std::string_view, 12> kPlans = {".ifc", ".ifczip", ".dxf", ".svg", ".obj",   ".ply",
                                                       ".stl", ".gltf",   ".glb", ".dae", ".world", ".sdf"};
  const fs::path plain = path.extension() == ".gz" ? path.stem() : path;
  return bytes == "ISO-10303-21" || HasExtension(plain, kPlans) ? InputKind::kPlan : InputKind::kOther;
}

bool HoldsScans(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".pcd") return true;
  }
  return false;
}

// "`rec/`" is the folder `rec`.
fs::path WithoutSlash(const std::string& path) {
  const fs::path given(path);
  return given.has_filename() ? given : given.parent_path();
}

std::string Named(InputKind kind) {
  switch (kind) {
    case InputKind::kPlan: return "a plan";
    case InputKind::kAGraph: return "an A-Graph";
    case InputKind::kRecording: return "a recording";
    case InputKind::kScans: return "a folder of scans";
    case InputKind::kRun: return "the folder of a run";
    case InputKind::kFolder: return "a folder";
    default: return "a file";
  }
}

std::string InFull(InputKind wanted) {
  switch (wanted) {
    case InputKind::kPlan: return "a plan: IFC, DXF, SVG, a mesh or SDF";
    case InputKind::kRecording: return "a recording: a folder with scans/*.pcd";
    case InputKind::kRun: return "the folder of a run: `plumb localize` writes those";
    default: return "an A-Graph: `plumb compile` makes those of plans";
  }
}

// How to get what is wanted from what was given, or what takes what was given.
std::string Hint(const Input& input, InputKind kind) {
  const fs::path path = WithoutSlash(input.path);
  const auto is = [&](InputKind given, InputKind wanted) { return kind == given && input.wanted == wanted; };
  if (is(InputKind::kPlan, InputKind::kAGraph))
    return fmt::format("`plumb compile {} -o {}` makes an A-Graph of it", input.path, path.stem().string() + ".agraph");
  if (is(InputKind::kAGraph, InputKind::kPlan)) return fmt::format("`plumb inspect {}` shows what is in it", input.path);
  if (is(InputKind::kScans, InputKind::kRecording)) {
    return path.filename() == "scans"
               ? fmt::format("the recording is the folder around it, `{}`", path.parent_path().empty() ? "." : path.parent_path().string())
               : fmt::format("move them into `{}`", (path / "scans").string());
  }
  if (is(InputKind::kRun, InputKind::kRecording)) {
    const Expected<RunInfo> info = ReadRunInfo(path.string());
    return info ? fmt::format("it was made from the recording `{}`", info->recording_path) : std::string();
  }
  if (is(InputKind::kRecording, InputKind::kRun))
    return fmt::format("`plumb localize FILE.agraph {} -o RUN` makes a run of it", input.path);
  if (kind == InputKind::kRecording) return fmt::format("`plumb doctor {}` looks at it", input.path);
  if (kind == InputKind::kRun) return fmt::format("`plumb report {} -o FILE.html` shows it", input.path);
  if (kind == InputKind::kAGraph || kind == InputKind::kPlan) return fmt::format("`plumb validate {}` looks at it", input.path);
  constexpr std::array<std::string_view, 4> kBags = {".bag", ".mcap", ".db3", ".pcap"};
  if (is(InputKind::kOther, InputKind::kRecording) && HasExtension(path, kBags))
    return "bags and packets are not read: write their sweeps as PCD";
  return {};
}

// What looks like nothing known may still be it: the reader says what is wrong with it.
bool MayBe(InputKind kind, const Input& input) {
  if (kind == input.wanted) return true;
  std::error_code error;  // a run may have been written into a recording
  if (input.wanted == InputKind::kRecording && fs::is_directory(fs::path(input.path) / "scans", error)) return true;
  const bool wants_file = input.wanted == InputKind::kPlan || input.wanted == InputKind::kAGraph;
  return kind == (wants_file ? InputKind::kOther : InputKind::kFolder);
}

}  // namespace

InputKind KindOf(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return InputKind::kMissing;
  if (!fs::is_directory(status)) return fs::is_regular_file(status) ? KindOfFile(path) : InputKind::kOther;
  if (fs::exists(fs::path(path) / "run.json", error)) return InputKind::kRun;
  if (fs::is_directory(fs::path(path) / "scans", error)) return InputKind::kRecording;
  return HoldsScans(path) ? InputKind::kScans : InputKind::kFolder;
}

Expected<void> CheckInputs(const std::vector<Input>& inputs) {
  std::vector<InputKind> kinds;
  for (const Input& input : inputs) kinds.push_back(KindOf(input.path));
  if (inputs.size() == 2 && kinds[0] == inputs[1].wanted && kinds[1] == inputs[0].wanted) {
    return Fail(ErrorCode::kBadOption, fmt::format("`{}` is {} and `{}` is {}: they are asked for the other way round", inputs[0].path,
                                                   Named(kinds[0]), inputs[1].path, Named(kinds[1])));
  }
  for (size_t i = 0; i < inputs.size(); ++i) {
    if (kinds[i] == InputKind::kMissing)
      return Fail(ErrorCode::kFileNotFound, fmt::format("there is no file or folder `{}`", inputs[i].path));
    if (MayBe(kinds[i], inputs[i])) continue;
    const std::string hint = Hint(inputs[i], kinds[i]);
    return Fail(ErrorCode::kBadOption,
                fmt::format("`{}` is {}, not {}{}{}", inputs[i].path, Named(kinds[i]),
                            hint.empty() ? InFull(inputs[i].wanted) : Named(inputs[i].wanted), hint.empty() ? "" : "; ", hint));
  }
  return {};
}

}  // namespace plumb::tools
