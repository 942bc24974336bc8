// A plan file in memory: its bytes as the frontends read them, its checksum and its format.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/diagnostics/diagnostic.h"

namespace plumb::compiler {

enum class SourceFormat {
  kUnknown,
  kIfcStep,
  kDxf,
  kSvg,
  kDwg,
  kXml,
  kZip,
  kPly,
  kGltf,
  kGltfJson,
  kObj,
  kStl,
  kCollada,
  kSdf,
  kPicture,
  kAGraph
};

struct Source {
  std::string path;
  std::string bytes;   // decompressed
  std::string sha256;  // of `bytes`, 64 hexadecimal digits: the same for a plain file, its .gz and its .ifczip
  SourceFormat format = SourceFormat::kUnknown;
};

struct SourceOptions {
  size_t max_bytes = size_t{2} << 30;             // of the file as it lies on the disk
  size_t max_unpacked_bytes = size_t{256} << 20;  // of a compressed one: a small file must not unpack to all of the memory
  // Empty if every field is valid; else names the field, its value and the rule.
  [[nodiscard]] std::string Check() const;
};

// Reads the file at `path`, plain, gzip or a ZIP archive with one plan in it (.ifczip), told apart by its first bytes. None: it could not
// be read or is too large, and an error says so.
[[nodiscard]] std::optional<Source> LoadSource(const std::string& path, DiagnosticSink& diagnostics, const SourceOptions& options = {});

// Told by the first bytes alone, never by the file's name.
[[nodiscard]] SourceFormat DetectFormat(std::string_view bytes);
[[nodiscard]] std::string_view FormatName(SourceFormat format);  // "IFC in STEP syntax", for messages

[[nodiscard]] std::string_view SchemaName(SourceFormat format);  // "OBJ", as A-Graphs name their source; for formats with one schema only
[[nodiscard]] bool IsMesh(SourceFormat format);

// Emits UnknownFormat, with how to go on from there, if no frontend reads `source`.
[[nodiscard]] bool IsSupported(const Source& source, DiagnosticSink& diagnostics);

}  // namespace plumb::compiler
