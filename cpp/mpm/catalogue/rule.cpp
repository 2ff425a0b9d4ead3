#include "mpm/catalogue/rule.hpp"

#include <sstream>

namespace mpm {

std::string Rule::text() const {
  if (std::isinf(lower)) return "must be a finite number";
  if (std::isinf(upper)) return "must be " + formula();
  std::ostringstream text;
  text << "must lie between " << lower << " and " << upper << ", "
       << (lower_open == upper_open ? "both"
           : lower_open             ? "the first"
                                    : "the second")
       << (lower_open || upper_open ? " excluded" : " included");
  return text.str();
}

std::string Rule::formula() const {
  std::ostringstream text;
  if (std::isinf(lower)) return "";
  if (std::isinf(upper)) {
    text << (lower_open ? "> " : ">= ") << lower;
  } else {
    text << lower << (lower_open ? " < f " : " <= f ") << (upper_open ? "< " : "<= ") << upper;
  }
  return text.str();
}

}  // namespace mpm
