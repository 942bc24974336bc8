#include "tools/plumb/flag_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

namespace plumb::tools {
namespace {

constexpr auto kFlags = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"CompileOptions.section_height_m", "--section-height"},
    {"CompileOptions.snap_radius_m", "--snap-radius"},
    {"CompileOptions.max_gap_m", "--max-gap"},
    {"CompileOptions.min_room_area_m2", "--min-room-area"},
    {"MeshOptions.unit", "--unit"},
    {"MeshOptions.up", "--up"},
    {"MeshOptions.section_height_m", "--section-height"},
    {"DrawingFileOptions.unit", "--unit"},
    {"DrawingFileOptions.scale_m", "--scale"},
    {"DrawingFileOptions.sheet", "--sheet"},
    {"HeightOptions.storey_m", "--storey-height"},
    {"HeightOptions.door_m", "--door-height"},
    {"HeightOptions.sill_m", "--sill-height"},
    {"HeightOptions.window_top_m", "--window-top"},
    {"MassOptions.single_line_thickness_m", "--wall-thickness"},
    {"FloorPlanOptions.section_height_m", "--section-height"},
    {"OccupancyOptions.height_m", "--sensor-height"},
    {"OccupancyOptions.resolution_m", "--resolution"},
    {"EvaluateOptions.wrong_fix_m", "--wrong-fix-distance"},
    {"EvaluateOptions.min_points", "--min-points"},
    {"ReplayOptions.start_s", "--start"},
    {"ReplayOptions.max_duration_s", "--max-duration"},
    {"ReplayOptions.threads", "--threads"},
    {"ReplayOptions.rate", "--rate"},
    {"DeviationOptions.min_offset_m", "--tolerance"},
    {"DeviationOptions.false_discovery_rate", "--false-discovery-rate"},
    {"MatcherOptions.accept_probability", "--accept-probability"},
    {"StartHint.near_m", "--near"},
    {"StartHint.near_sigma_m", "--near X,Y,SIGMA with a SIGMA of"},
    {"SimulateOptions.deviate", "--deviate"},
    {"SimulateOptions.missing", "--missing"},
    {"SimulateOptions.unplanned", "--unplanned"},
    {"SimulateOptions.doorways", "--doorways"},
    {"SimulateOptions.sensor", "--sensor"},
    {"SimulateOptions.noise_m", "--noise"},
    {"SimulateOptions.speed_m_s", "--speed"},
    {"SimulateOptions.sensor_height_m", "--sensor-height"},
    {"SimulateOptions.min_duration_s", "--duration"},
    {"SimulateOptions.max_duration_s", "--max-duration"},
    {"SimulateOptions.glass_transmission", "--glass-transmission"},
    {"SimulateOptions.clutter", "--clutter"},
});
constexpr std::string_view kIs = " = ";

bool IsOfName(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// The flags of other fields of the same options: of words with a unit behind them, "sill_m", and of those that a value follows, "unit =
// cm".
std::string OthersInFlags(std::string_view text, std::string_view options) {
  std::string out;
  while (!text.empty()) {
    const auto length = static_cast<size_t>(std::find_if_not(text.begin(), text.end(), IsOfName) - text.begin());
    const std::string_view word = text.substr(0, length);
    const bool has_value = text.substr(length).starts_with(kIs);
    const auto known = std::find_if(kFlags.begin(), kFlags.end(),
                                    [&](const auto& f) { return f.first.starts_with(options) && f.first.substr(options.size()) == word; });
    if (known != kFlags.end() && (has_value || word.find('_') != std::string_view::npos)) {
      out += known->second;
      text.remove_prefix(length);
      if (has_value) out += ' ', text.remove_prefix(kIs.size());
    } else {
      out += text.substr(0, std::max<size_t>(length, 1));
      text.remove_prefix(std::max<size_t>(length, 1));
    }
  }
  return out;
}

}  // namespace

std::string InFlags(const std::string& fault) {
  const size_t end = fault.find(kIs);
  const auto known =
      std::find_if(kFlags.begin(), kFlags.end(), [&](const auto& f) { return f.first == std::string_view(fault).substr(0, end); });
  if (end == std::string::npos || known == kFlags.end()) return fault;
  const std::string_view options = known->first.substr(0, known->first.find('.') + 1);
  return std::string(known->second) + " " + OthersInFlags(std::string_view(fault).substr(end + kIs.size()), options);
}

}  // namespace plumb::tools
