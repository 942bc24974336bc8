// The index of a STEP physical file (ISO 10303-21): where each instance stands and of which type it is. One pass over the text finds the
// instances; arguments are parsed when asked for (step_value.h).
//
// Guarantees: (1) never crashes on any bytes; what is wrong becomes a StepSyntax diagnostic with its line, and what can be read is kept;
// (2) memory is flat arrays, about 20 bytes an instance; (3) Find is constant time where ids are spread evenly, logarithmic otherwise.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/ifc/step_value.h"

namespace plumb::compiler {

class StepFile {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;

  // Indexes `text`, which must outlive the result and be shorter than 4 GiB. None: it is no STEP file at all, and an error says so.
  [[nodiscard]] static std::optional<StepFile> Index(std::string_view text, DiagnosticSink& diagnostics);

  [[nodiscard]] size_t text_size() const { return text_.size(); }

  // Instances are numbered in the order of the file.
  [[nodiscard]] uint32_t size() const { return static_cast<uint32_t>(ids_.size()); }
  [[nodiscard]] uint64_t id(uint32_t instance) const { return ids_[instance]; }  // 12 of #12
  [[nodiscard]] uint32_t Find(uint64_t id) const;                                // kNone if the file has no such id
  [[nodiscard]] StepArguments Arguments(uint32_t instance) const {
    // Up to the next instance: arguments without an end would else be read to the end of the file, once for each instance.
    const size_t end = instance + 1 < size() ? offsets_[instance + 1] : text_.size();
    return {text_.data() + offsets_[instance], text_.data() + end};
  }
  // Where its `#` stands, both counted from 1; columns in bytes.
  [[nodiscard]] uint32_t Line(uint32_t instance) const { return LineAt(StartOf(instance)); }
  [[nodiscard]] uint32_t Column(uint32_t instance) const { return ColumnAt(StartOf(instance)); }

  // Types are numbered in the order of their first use; names as written, in capitals.
  [[nodiscard]] uint16_t type(uint32_t instance) const { return types_[instance]; }
  [[nodiscard]] size_t type_count() const { return type_names_.size(); }
  [[nodiscard]] const std::string& type_name(uint16_t type) const { return type_names_[type]; }
  [[nodiscard]] std::span<const uint32_t> InstancesOf(uint16_t type) const;  // in the order of the file

  [[nodiscard]] const std::string& schema_name() const { return schema_name_; }  // "IFC4", first name of FILE_SCHEMA, in capitals
  // False: the text ends inside its data section, and a FileCutOff error says so; what is whole was indexed.
  [[nodiscard]] bool is_whole() const { return is_whole_; }

 private:
  friend class StepIndexer;
  StepFile() = default;
  void BuildLookup();
  void ReportDuplicates(DiagnosticSink& diagnostics) const;
  [[nodiscard]] uint32_t ById(size_t rank) const { return by_id_.empty() ? static_cast<uint32_t>(rank) : by_id_[rank]; }
  void BuildTypeLists();
  [[nodiscard]] size_t StartOf(uint32_t instance) const;
  [[nodiscard]] uint32_t LineAt(size_t offset) const;
  [[nodiscard]] uint32_t ColumnAt(size_t offset) const;

  std::string_view text_;
  std::vector<uint64_t> ids_;
  std::vector<uint32_t> offsets_;  // of the argument list's parenthesis
  std::vector<uint16_t> types_;
  std::vector<std::string> type_names_;
  std::vector<uint32_t> by_type_, type_starts_;  // instances grouped by type
  std::vector<uint32_t> by_id_;                  // instances sorted by id; empty: they are in the order of the file
  std::vector<uint32_t> bucket_starts_;          // in that order, the first id of each range of 2^bucket_bits_ ids; then the end
  int bucket_bits_ = 0;
  std::string schema_name_;
  bool is_whole_ = true;
  char newline_ = '\n';
  std::vector<uint32_t> line_blocks_;  // newlines before each block of the text
};

}  // namespace plumb::compiler
