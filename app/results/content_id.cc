#include "app/results/content_id.h"

#include <fmt/format.h>

#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>

namespace annulus::app {

ContentId& ContentId::add(const std::string& name, double value) { return add(name, fmt::format("{:.17g}", value)); }

ContentId& ContentId::add(const std::string& name, const std::string& value) {
  text_ += name + " = " + value + "\n";
  return *this;
}

std::string ContentId::id() const {
  const boost::uuids::name_generator_sha1 generate(boost::uuids::ns::oid());
  return boost::uuids::to_string(generate(std::string("annulus ") + version() + "\n" + text_));
}

const char* version() { return ANNULUS_VERSION; }

}  // namespace annulus::app
