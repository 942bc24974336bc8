// An IFC file as instances with types, over the STEP index: what all parts of the frontend look things up in.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/ifc/ifc_attributes.h"
#include "compiler/frontends/ifc/step_file.h"

namespace plumb::compiler {

enum class IfcType : uint16_t {
  kUnknown,
#define PLUMB_IFC_TYPE(name) k##name,
#include "compiler/frontends/ifc/ifc_types.def"
#undef PLUMB_IFC_TYPE
};

// One instance: its type and arguments. False: there is none.
struct IfcInstance {
  uint32_t index = StepFile::kNone;
  IfcType type = IfcType::kUnknown;
  StepArguments arguments;
  explicit operator bool() const { return index != StepFile::kNone; }
  StepValue operator[](size_t attribute_index) const { return arguments[attribute_index]; }
};

// More than twice the Earth's circumference: beyond it a coordinate is a mistake, and products of coordinates would lose their meaning.
inline constexpr double kMaxCoordinate_m = 1e8;
// Beyond this it is no mistake but no number either, as is NaN: a file with such numbers is refused.
inline constexpr double kNoCoordinate_m = 1e15;
[[nodiscard]] inline bool IsNumber(const Eigen::Vector3d& p_m) { return p_m.allFinite() && p_m.cwiseAbs().maxCoeff() < kNoCoordinate_m; }
[[nodiscard]] inline bool IsCoordinate(const Eigen::Vector3d& p_m) {
  return p_m.allFinite() && p_m.cwiseAbs().maxCoeff() <= kMaxCoordinate_m;
}

class IfcModel {
 public:
  // Indexes `text`, which must outlive the model. None: it is no IFC file of a known release, and an error says so.
  [[nodiscard]] static std::optional<IfcModel> Open(std::string_view text, DiagnosticSink& diagnostics);

  [[nodiscard]] const StepFile& file() const { return file_; }
  [[nodiscard]] uint32_t size() const { return file_.size(); }
  [[nodiscard]] const std::string& schema_name() const { return file_.schema_name(); }
  [[nodiscard]] IfcType TypeOf(uint32_t index) const { return types_[file_.type(index)]; }
  [[nodiscard]] std::string TypeName(uint32_t index) const;  // "IfcWall"; in capitals for types that the frontend does not tell apart
  [[nodiscard]] std::span<const uint32_t> InstancesOf(IfcType type) const;

  [[nodiscard]] IfcInstance Get(uint32_t index) const { return {index, TypeOf(index), file_.Arguments(index)}; }
  // What a reference leads to. None: the value is no reference, or (MissingReference) the file has no such id.
  [[nodiscard]] IfcInstance Follow(StepValue reference) const;
  [[nodiscard]] uint32_t Resolve(StepValue reference) const;  // the same, StepFile::kNone for none

  // Numbers in metres and radians; `fallback` where the attribute is unset or (BadAttribute, NumberNotFinite) no number.
  [[nodiscard]] double Length(const IfcInstance& instance, size_t attribute_index, double fallback = 0) const;
  [[nodiscard]] double Number(const IfcInstance& instance, size_t attribute_index, double fallback = 0) const;
  [[nodiscard]] double length_scale() const { return length_scale_; }  // metres in a unit of the file
  [[nodiscard]] double angle_scale() const { return angle_scale_; }    // radians in a unit of the file
  void SetUnits(double length_scale, double angle_scale) { length_scale_ = length_scale, angle_scale_ = angle_scale; }

  [[nodiscard]] SourceLocation Location(uint32_t index) const;
  // `#12 IfcDoor`, as messages name an instance.
  [[nodiscard]] std::string Label(uint32_t index) const;
  // At most kMaxPerKind of a kind, the last of which says so.
  void Emit(DiagnosticKind kind, uint32_t index, std::string message, std::string hint = {}) const;
  // What was said about the file leaves no plan to trust: it is cut off, contains itself, holds numbers that are none, or is too complex.
  [[nodiscard]] bool is_refused() const { return is_refused_; }
  // It is not worth reading on.
  [[nodiscard]] bool is_too_complex() const { return is_too_complex_; }
  // Counts steps of reading shapes. A small file can share its parts so that they unfold without bound: false, with a PlanTooComplex
  // diagnostic about `index`, once the steps are out of all proportion to the file.
  [[nodiscard]] bool Spend(size_t steps, uint32_t index) const;
  // Counts steps of following curved surfaces, each about a nanosecond. False: what is left, in proportion to the file, is not enough;
  // nothing is counted then, and the surface is to be simplified.
  [[nodiscard]] bool SpendOnSurface(size_t steps) const;
  [[nodiscard]] DiagnosticSink& diagnostics() const { return *diagnostics_; }

 private:
  static constexpr size_t kMaxPerKind = 5000;
  IfcModel(StepFile file, DiagnosticSink& diagnostics);
  void EmitAt(DiagnosticKind kind, SourceLocation location, std::string message, std::string hint) const;

  StepFile file_;
  DiagnosticSink* diagnostics_;
  std::vector<IfcType> types_;              // by the file's type number
  std::vector<uint16_t> file_types_;        // the file's type number by IfcType, or kNoFileType
  mutable std::set<uint64_t> missing_ids_;  // reported already
  mutable std::map<DiagnosticKind, size_t> emitted_;
  mutable size_t steps_left_, surface_steps_left_;
  mutable bool is_refused_ = false, is_too_complex_ = false;
  double length_scale_ = 1, angle_scale_ = 1;
};

}  // namespace plumb::compiler
