// Unpacking gzip files and ZIP archives, with bounds: what they say of their own sizes is not believed.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "schema/error.h"

namespace plumb::compiler {

[[nodiscard]] bool IsGzip(std::string_view bytes);
[[nodiscard]] bool IsZip(std::string_view bytes);

// All members of a gzip file (RFC 1952), one after the other. Errors: kFileTooLarge above `max_bytes`, kFileUnreadable for damaged data.
[[nodiscard]] Expected<std::string> InflateGzip(std::string_view packed, size_t max_bytes);

// The plan in a ZIP archive (PKWARE APPNOTE 6.3; stored and deflated entries, no ZIP64, no encryption): the entry whose name ends in .ifc,
// or the only entry; the CRC is checked. Errors: as above, and kFileUnreadable for an archive without a plan or with several.
[[nodiscard]] Expected<std::string> UnpackPlan(std::string_view archive, size_t max_bytes);

}  // namespace plumb::compiler
