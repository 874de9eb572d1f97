#pragma once

#include <string>
#include <vector>

#include "records.h"

namespace annulus::manual {

/// The manual: introduction, an overview, every case with its table and pictures, by layer and suite.
/// Of cases with the label `verification` that recorded nothing the names stand at the end of their suite.
[[nodiscard]] std::string page(const std::string& introduction, const std::vector<ListedCase>& cases,
                               const Records& records);

/// The part of the page that belongs to one case.
[[nodiscard]] std::string case_section(const CaseName& name, const Record& record);

/// File name of a picture below the folder `verification` beside the page.
[[nodiscard]] std::string picture_name(const CaseName& name, std::size_t number);
[[nodiscard]] std::string picture_svg(const Picture& picture);

}  // namespace annulus::manual
