#include "app/sections/shafts.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/model/gear_system.h"
#include "app/sections/report_parts.h"

namespace annulus::app {

Json to_json(const std::vector<dynamics::ShaftResult>& shafts) {
  auto list = Json::array();
  for (const auto& shaft : shafts)
    list.push_back({{"rotor", shaft.name},
                    {"on", shaft.on},
                    {"nominal_torque_N_m", shaft.nominal_torque},
                    {"mean_torque_N_m", json_number(shaft.mean_torque)},
                    {"smallest_torque_N_m", json_number(shaft.smallest_torque)},
                    {"largest_torque_N_m", annulus::to_json(shaft.largest_torque)},
                    {"torque_factor", annulus::to_json(shaft.torque_factor())},
                    {"contact_loss", annulus::to_json(shaft.contact_loss)}});
  return list;
}

Section shafts_section(const SystemRun& run) {
  Section section{"shafts", "Shafts"};
  if (run.responses.empty()) return section;
  PageTable table{.head = {"shaft", "nominal torque", "mean torque", "smallest torque", "largest torque",
                           "largest / nominal", "couplings free, % of the time"},
                  .style = PageTable::Style::numbers};
  const auto variants = run.system->run_variants();
  for (std::size_t i = 0; i < run.responses.size(); ++i) {
    const auto& shafts = run.responses[i]->shafts;
    if (!shafts.empty() && variants.size() > 1 && !variants.at(i).name.empty())
      table.rows.push_back({variants.at(i).name});
    for (const auto& shaft : shafts)
      table.rows.push_back({fmt::format("{} – {}", shaft.name, shaft.on),
                            text_in_unit(shaft.nominal_torque, shown_units::torque),
                            text_in_unit(shaft.mean_torque, shown_units::torque),
                            text_in_unit(shaft.smallest_torque, shown_units::torque),
                            measured_in_unit(shaft.largest_torque, shown_units::torque),
                            measured(shaft.torque_factor(), 1), measured(shaft.contact_loss, 100)});
  }
  if (table.rows.empty()) return section;
  section.blocks =
      table + paragraph(
                  "Torques of the shafts between the rotors and the gear set, positive in the sense of the "
                  "nominal one. Where the smallest one is negative, couplings with backlash bear on their "
                  "other sides.");
  return section;
}

}  // namespace annulus::app
