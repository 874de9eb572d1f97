#include "app/pair_run.h"
namespace annulus::app {
std::string pair_report_html(const PairRunResult&) { return ""; }
}  // namespace annulus::app
