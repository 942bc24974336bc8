#include "tools/plumb/updates.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "schema/files.h"

namespace plumb::tools {

UpdateWriter::UpdateWriter(const AGraph& plan, std::string stream_path, std::string deviations_path)
    : plan_(plan), stream_path_(std::move(stream_path)), deviations_path_(std::move(deviations_path)) {}

Expected<void> UpdateWriter::Open() {
  if (stream_path_.empty()) return {};
  stream_.open(stream_path_, std::ios::trunc);
  if (!stream_) return Fail(ErrorCode::kFileUnwritable, fmt::format("cannot write `{}`", stream_path_));
  return {};
}

void UpdateWriter::Write(const runtime::EstimateUpdate& update) {
  if (failure_) return;
  if (stream_.is_open()) {
    stream_ << runtime::UpdateToJson(update, told_) << std::flush;
    if (!stream_) failure_ = Error{ErrorCode::kFileUnwritable, fmt::format("cannot write on to `{}`", stream_path_)};
  }
  if (!update.requested) return;
  const auto written = WriteFileAtomically(deviations_path_, std::string_view(runtime::DeviationsToJson(plan_, update.deviations)));
  if (!written) failure_ = written.error();
}

Expected<void> UpdateWriter::Close() {
  if (stream_.is_open()) stream_.close();
  if (failure_) return tl::unexpected(*failure_);
  return {};
}

}  // namespace plumb::tools
