#include "compiler/frontends/ifc/ifc_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace plumb::compiler {
namespace {

constexpr std::string_view kTypeNames[] = {
    "",
#define PLUMB_IFC_TYPE(name) #name,
#include "compiler/frontends/ifc/ifc_types.def"
#undef PLUMB_IFC_TYPE
};
constexpr uint16_t kNoFileType = 0xffff;
constexpr size_t kGuidLength = 22;

char Upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

bool Refuses(DiagnosticKind kind) {
  return kind == DiagnosticKind::kFileCutOff || kind == DiagnosticKind::kReferenceCycle || kind == DiagnosticKind::kNumberNotFinite ||
         kind == DiagnosticKind::kPlanTooComplex || kind == DiagnosticKind::kNoBuilding;
}

bool EqualsIgnoringCase(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return Upper(x) == Upper(y); });
}

}  // namespace

IfcModel::IfcModel(StepFile file, DiagnosticSink& diagnostics) : file_(std::move(file)), diagnostics_(&diagnostics) {
  constexpr size_t kMinSteps = 1000000, kStepsPerByte = 4;
  is_refused_ = !file_.is_whole();
  steps_left_ = kMinSteps + kStepsPerByte * file_.text_size();
  constexpr size_t kMinSurfaceSteps = 100000000, kSurfaceStepsPerByte = 60;
  surface_steps_left_ = kMinSurfaceSteps + kSurfaceStepsPerByte * file_.text_size();
  types_.assign(file_.type_count(), IfcType::kUnknown);
  file_types_.assign(std::size(kTypeNames), kNoFileType);
  for (size_t t = 0; t < file_.type_count(); ++t) {
    const std::string& name = file_.type_name(static_cast<uint16_t>(t));
    for (size_t k = 1; k < std::size(kTypeNames); ++k) {
      if (!EqualsIgnoringCase(kTypeNames[k], name)) continue;
      types_[t] = static_cast<IfcType>(k);
      file_types_[k] = static_cast<uint16_t>(t);
      break;
    }
  }
}

std::optional<IfcModel> IfcModel::Open(std::string_view text, DiagnosticSink& diagnostics) {
  std::optional<StepFile> file = StepFile::Index(text, diagnostics);
  if (!file) return std::nullopt;
  const std::string& schema = file->schema_name();
  if (!schema.starts_with("IFC2X") && !schema.starts_with("IFC4")) {
    diagnostics.Emit(DiagnosticKind::kUnknownSchema, {},
                     schema.empty() ? std::string("the header states no schema; FILE_SCHEMA must name IFC2X, IFC2X3, IFC4 or IFC4X3")
                                    : fmt::format("the schema is `{}`; IFC2X, IFC2X3, IFC4 and IFC4X3 are read", schema),
                     "export the plan as IFC4 or IFC2X3");
    return std::nullopt;
  }
  return IfcModel(std::move(*file), diagnostics);
}

std::string IfcModel::TypeName(uint32_t index) const {
  const IfcType type = TypeOf(index);
  return type == IfcType::kUnknown ? file_.type_name(file_.type(index)) : std::string(kTypeNames[static_cast<size_t>(type)]);
}

std::span<const uint32_t> IfcModel::InstancesOf(IfcType type) const {
  const uint16_t file_type = file_types_[static_cast<size_t>(type)];
  return file_type == kNoFileType ? std::span<const uint32_t>() : file_.InstancesOf(file_type);
}

uint32_t IfcModel::Resolve(StepValue reference) const {
  const std::optional<uint64_t> id = reference.Reference();
  if (!id) return StepFile::kNone;
  const uint32_t index = file_.Find(*id);
  if (index == StepFile::kNone && missing_ids_.size() < kMaxPerKind && missing_ids_.insert(*id).second) {
    SourceLocation location;
    location.step_id = *id;
    EmitAt(DiagnosticKind::kMissingReference, location, fmt::format("`#{}` is referred to, but the file has no such instance", *id), {});
  }
  return index;
}

IfcInstance IfcModel::Follow(StepValue reference) const {
  const uint32_t index = Resolve(reference);
  return index == StepFile::kNone ? IfcInstance() : Get(index);
}

double IfcModel::Number(const IfcInstance& instance, size_t attribute_index, double fallback) const {
  const StepValue value = instance[attribute_index];
  if (value.is_null() || value.kind() == StepValue::Kind::kDerived) return fallback;
  if (const std::optional<double> number = value.Real()) return *number;
  const DiagnosticKind kind = value.IsNotFinite() ? DiagnosticKind::kNumberNotFinite : DiagnosticKind::kBadAttribute;
  Emit(kind, instance.index,
       fmt::format("attribute {} of {} is no number; it is taken as {}", attribute_index + 1, Label(instance.index), fallback));
  return fallback;
}

double IfcModel::Length(const IfcInstance& instance, size_t attribute_index, double fallback) const {
  const double length_m = Number(instance, attribute_index, fallback / length_scale_) * length_scale_;
  if (std::abs(length_m) <= kMaxCoordinate_m) return length_m;
  const DiagnosticKind kind = std::abs(length_m) < kNoCoordinate_m ? DiagnosticKind::kBadAttribute : DiagnosticKind::kNumberNotFinite;
  Emit(kind, instance.index,
       fmt::format("attribute {} of {} is over {} m; it is taken as {} m", attribute_index + 1, Label(instance.index), kMaxCoordinate_m,
                   fallback));
  return fallback;
}

SourceLocation IfcModel::Location(uint32_t index) const {
  if (index == StepFile::kNone) return {};
  SourceLocation location;
  location.line = file_.Line(index);
  location.column = file_.Column(index);
  location.step_id = file_.id(index);
  location.type = TypeName(index);
  const StepValue first = file_.Arguments(index)[attribute::kGlobalId];
  if (first.kind() == StepValue::Kind::kString) {
    location.guid = first.Text();
    if (location.guid.size() != kGuidLength) location.guid.clear();
  }
  return location;
}

std::string IfcModel::Label(uint32_t index) const { return fmt::format("`#{} {}`", file_.id(index), TypeName(index)); }

void IfcModel::Emit(DiagnosticKind kind, uint32_t index, std::string message, std::string hint) const {
  EmitAt(kind, Location(index), std::move(message), std::move(hint));
}

bool IfcModel::Spend(size_t steps, uint32_t index) const {
  if (steps <= steps_left_) {
    steps_left_ -= steps;
    return true;
  }
  steps_left_ = 0;
  if (!is_too_complex_) {
    Emit(
        DiagnosticKind::kPlanTooComplex, index,
        fmt::format("the shapes of the file unfold out of all proportion to its {} bytes, {} among them", file_.text_size(), Label(index)));
  }
  return false;
}

bool IfcModel::SpendOnSurface(size_t steps) const {
  if (steps > surface_steps_left_) return false;
  surface_steps_left_ -= steps;
  return true;
}

void IfcModel::EmitAt(DiagnosticKind kind, SourceLocation location, std::string message, std::string hint) const {
  is_refused_ |= Refuses(kind);
  is_too_complex_ |= kind == DiagnosticKind::kPlanTooComplex;
  // Cycles with many branches are met again and again: they use up the steps sooner.
  constexpr size_t kStepsPerCycle = 1000;
  if (kind == DiagnosticKind::kReferenceCycle) steps_left_ -= std::min(steps_left_, kStepsPerCycle);
  const size_t count = ++emitted_[kind];
  if (count > kMaxPerKind) return;
  if (count == kMaxPerKind) message += "; further ones are not listed";
  diagnostics_->Emit(kind, std::move(location), std::move(message), std::move(hint));
}

}  // namespace plumb::compiler
