#include "compiler/source/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <utility>

#include "compiler/source/inflate.h"
#include "compiler/source/sha256.h"
#include "schema/files.h"

namespace plumb::compiler {
namespace {

constexpr size_t kDetectionBytes = 4096;
constexpr size_t kXmlDetectionBytes = 65536;  // comments and entities may stand before the root element

std::string_view SkipMarkAndSpace(std::string_view bytes) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  const size_t start = bytes.find_first_not_of(" \t\r\n");
  return start == std::string_view::npos ? std::string_view() : bytes.substr(start);
}

// A DXF in text form opens with group code 0 (or a 999 comment) on a line of its own, then SECTION.
bool LooksLikeDxf(std::string_view head) {
  if (head.starts_with("AutoCAD Binary DXF")) return true;
  if (!head.starts_with("0") && !head.starts_with("999")) return false;
  const size_t section = head.find("SECTION");
  return section != std::string_view::npos && head.find_first_of("\r\n") < section;
}

// The first words of lines that only OBJ files begin with; a photograph has none.
bool LooksLikeObj(std::string_view head) {
  size_t known = 0;
  bool vertex = false;
  while (!head.empty()) {
    const size_t end = std::min(head.find('\n'), head.size());
    const bool whole = end < head.size();
    const std::string_view line = SkipMarkAndSpace(head.substr(0, end));
    head.remove_prefix(std::min(end + 1, head.size()));
    if (line.empty() || !whole || line.starts_with('#')) continue;
    const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
    constexpr std::array kWords = {"v", "vn", "vt", "vp", "f", "l", "p", "o", "g", "s", "usemtl", "mtllib", "usemap", "mg"};
    if (std::find(kWords.begin(), kWords.end(), word) == kWords.end()) return false;
    vertex |= word == "v";
    ++known;
  }
  return vertex || known >= 2;
}

// The text form says `solid` and `facet`; the binary one has 80 bytes of anything, the number of triangles, 50 bytes for each.
bool LooksLikeStl(std::string_view bytes, std::string_view head) {
  if (head.starts_with("solid") && head.find("facet") != std::string_view::npos) return true;
  constexpr size_t kHeader = 84, kTriangle = 50;
  if (bytes.size() < kHeader) return false;
  uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return bytes.size() == kHeader + kTriangle * size_t{count};
}

SourceFormat XmlFormat(std::string_view head) {
  if (head.find("<COLLADA") != std::string_view::npos) return SourceFormat::kCollada;
  if (head.find("<svg") != std::string_view::npos) return SourceFormat::kSvg;
  if (head.find("<sdf") != std::string_view::npos) return SourceFormat::kSdf;
  return SourceFormat::kXml;
}

// The beginning of a file of no known format, which tells people what it is: text to the end of its first line, else numbers.
std::string Beginning(std::string_view bytes) {
  constexpr size_t kText = 32, kBytes = 8;
  const std::string_view text = SkipMarkAndSpace(bytes);
  const std::string_view line = text.substr(0, std::min(text.find_first_of("\r\n"), kText));
  const auto is_plain = [](char c) { return (c >= 0x20 && c < 0x7f) || c == '\t'; };
  if (!line.empty() && std::all_of(line.begin(), line.end(), is_plain)) return fmt::format("`{}`", line);
  std::string out = "the bytes";
  for (const char c : bytes.substr(0, kBytes)) out += fmt::format(" {:02x}", static_cast<unsigned char>(c));
  return out;
}

bool IsNamedIfc(std::string_view path) { return path.ends_with(".ifc") || path.ends_with(".IFC"); }

std::string UnknownFormat(const Source& source) {
  if (source.bytes.empty()) return fmt::format("`{}` is empty", source.path);
  if (source.format != SourceFormat::kUnknown) {
    return fmt::format("`{}` is {}; a plan is read as IFC in STEP syntax, as a drawing (DXF, SVG), as a mesh or as SDF", source.path,
                       FormatName(source.format));
  }
  return fmt::format("`{}` begins with {}; {}", source.path, Beginning(source.bytes),
                     IsNamedIfc(source.path) ? "an IFC file in STEP syntax begins with `ISO-10303-21;`"
                                             : "no plan does: not IFC in STEP syntax, nor a drawing (DXF, SVG), a mesh or SDF");
}

const char* HintFor(SourceFormat format) {
  switch (format) {
    case SourceFormat::kAGraph: return "it is compiled already: `plumb inspect` shows what is in it";
    case SourceFormat::kDwg: return "save it as DXF in the CAD program, or convert it with `dwg2dxf` (LibreDWG) or the ODA File Converter";
    case SourceFormat::kZip: return "unpack the archive and give the plan in it";
    case SourceFormat::kPicture: return "a picture has no lines: trace it as DXF or SVG, or export the drawing that it was made from";
    default: return "export the plan as IFC (STEP, .ifc), DXF, SVG, a mesh (OBJ, PLY, STL, glTF, COLLADA) or a Gazebo world (SDF)";
  }
}

}  // namespace

std::string SourceOptions::Check() const {
  if (max_bytes == 0 || max_bytes >= std::numeric_limits<uint32_t>::max()) {
    return fmt::format("SourceOptions.max_bytes = {}; must be in 1..{}", max_bytes, std::numeric_limits<uint32_t>::max() - 1);
  }
  if (max_unpacked_bytes == 0 || max_unpacked_bytes >= std::numeric_limits<uint32_t>::max()) {
    return fmt::format("SourceOptions.max_unpacked_bytes = {}; must be in 1..{}", max_unpacked_bytes,
                       std::numeric_limits<uint32_t>::max() - 1);
  }
  return {};
}

SourceFormat DetectFormat(std::string_view bytes) {
  if (bytes.starts_with("PK\x03\x04")) return SourceFormat::kZip;
  const std::string_view head = SkipMarkAndSpace(bytes.substr(0, kDetectionBytes));
  if (head.starts_with("ISO-10303-21")) return SourceFormat::kIfcStep;
  if (bytes.substr(0, 8).ends_with("PLAG")) return SourceFormat::kAGraph;
  if (head.size() >= 6 && head.starts_with("AC10")) return SourceFormat::kDwg;
  if (head.starts_with("ply\n") || head.starts_with("ply\r")) return SourceFormat::kPly;
  if (head.starts_with("glTF")) return SourceFormat::kGltf;
  if (head.starts_with("%PDF") || head.starts_with("\xFF\xD8\xFF") || head.starts_with("\x89PNG")) return SourceFormat::kPicture;
  if (LooksLikeDxf(head)) return SourceFormat::kDxf;
  if (head.starts_with("<")) return XmlFormat(bytes.substr(0, kXmlDetectionBytes));
  if (head.starts_with("{") && head.find("\"asset\"") != std::string_view::npos) return SourceFormat::kGltfJson;
  if (LooksLikeStl(bytes, head)) return SourceFormat::kStl;
  if (LooksLikeObj(head)) return SourceFormat::kObj;
  return SourceFormat::kUnknown;
}

std::string_view FormatName(SourceFormat format) {
  switch (format) {
    case SourceFormat::kIfcStep: return "IFC in STEP syntax";
    case SourceFormat::kDxf: return "a DXF drawing";
    case SourceFormat::kSvg: return "an SVG drawing";
    case SourceFormat::kDwg: return "a DWG drawing";
    case SourceFormat::kXml: return "an XML document";
    case SourceFormat::kZip: return "a ZIP archive";
    case SourceFormat::kPly: return "a PLY mesh";
    case SourceFormat::kGltf:
    case SourceFormat::kGltfJson: return "a glTF mesh";
    case SourceFormat::kObj: return "an OBJ mesh";
    case SourceFormat::kStl: return "an STL mesh";
    case SourceFormat::kCollada: return "a COLLADA mesh";
    case SourceFormat::kSdf: return "a Gazebo world or model (SDF)";
    case SourceFormat::kPicture: return "a picture or a document (PDF, JPEG, PNG)";
    case SourceFormat::kAGraph: return "an A-Graph";
    case SourceFormat::kUnknown: break;
  }
  return "of no known format";
}

std::string_view SchemaName(SourceFormat format) {
  switch (format) {
    case SourceFormat::kDxf: return "DXF";
    case SourceFormat::kSvg: return "SVG";
    case SourceFormat::kPly: return "PLY";
    case SourceFormat::kGltf:
    case SourceFormat::kGltfJson: return "glTF";
    case SourceFormat::kObj: return "OBJ";
    case SourceFormat::kStl: return "STL";
    case SourceFormat::kCollada: return "COLLADA";
    case SourceFormat::kSdf: return "SDF";
    default: return "";
  }
}

bool IsMesh(SourceFormat format) {
  switch (format) {
    case SourceFormat::kPly:
    case SourceFormat::kGltf:
    case SourceFormat::kGltfJson:
    case SourceFormat::kObj:
    case SourceFormat::kStl:
    case SourceFormat::kCollada: return true;
    default: return false;
  }
}

std::optional<Source> LoadSource(const std::string& path, DiagnosticSink& diagnostics, const SourceOptions& options) {
  if (const std::string problem = options.Check(); !problem.empty()) {
    diagnostics.Emit(DiagnosticKind::kInternalError, {}, problem);
    return std::nullopt;
  }
  Expected<std::string> bytes = ReadFileText(path, options.max_bytes);
  if (!bytes) {
    const bool too_large = bytes.error().code == ErrorCode::kFileTooLarge;
    diagnostics.Emit(too_large ? DiagnosticKind::kFileTooLarge : DiagnosticKind::kFileUnreadable, {}, bytes.error().message);
    return std::nullopt;
  }
  Source source;
  source.path = path;
  if (IsGzip(*bytes) || IsZip(*bytes)) {
    const size_t max_bytes = options.max_unpacked_bytes;
    Expected<std::string> unpacked = IsGzip(*bytes) ? InflateGzip(*bytes, max_bytes) : UnpackPlan(*bytes, max_bytes);
    if (!unpacked) {
      const bool too_large = unpacked.error().code == ErrorCode::kFileTooLarge;
      diagnostics.Emit(too_large ? DiagnosticKind::kFileTooLarge : DiagnosticKind::kBadCompression, {},
                       fmt::format("`{}`: {}", path, unpacked.error().message),
                       too_large ? "unpack it and give the file in it" : "copy or download the file again");
      return std::nullopt;
    }
    source.bytes = std::move(*unpacked);
  } else {
    source.bytes = std::move(*bytes);
  }
  source.sha256 = Sha256Hex(source.bytes);
  source.format = DetectFormat(source.bytes);
  return source;
}

bool IsSupported(const Source& source, DiagnosticSink& diagnostics) {
  if (source.format == SourceFormat::kIfcStep || !SchemaName(source.format).empty()) return true;
  diagnostics.Emit(DiagnosticKind::kUnknownFormat, {}, UnknownFormat(source), HintFor(source.format));
  return false;
}

}  // namespace plumb::compiler
