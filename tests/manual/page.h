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

/// What the cases of a suite recorded, in their order; without those that recorded no figures.
[[nodiscard]] std::vector<const Record*> records_of(const std::string& layer, const std::string& suite,
                                                    const std::vector<ListedCase>& cases, const Records& records);
/// Picture of a suite: what part of its tolerance every quantity takes (the worst comparison of each).
[[nodiscard]] std::string tolerances_name(const std::string& layer, const std::string& suite);
[[nodiscard]] std::string tolerances_svg(const std::vector<const Record*>& cases);

}  // namespace annulus::manual
