#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace annulus {

/// Base of every error annulus raises on purpose. The message says what is wrong and how to cure it.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user's input is wrong: a scene, an argument, a file read back. Exit status 2.
class InputError : public Error {
 public:
  using Error::Error;
};

/// A gear, mesh or ring that cannot exist (undercut, interference, no contact, colliding planets). Exit status 2.
class GeometryError : public InputError {
 public:
  using InputError::InputError;
};

/// A computation did not reach its accuracy or was refused; nothing false is written. Exit status 3.
class SolverError : public Error {
 public:
  using Error::Error;
};

/// A broken invariant: a defect of annulus, not of its input.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws InternalError with the text of all `parts` when `condition` does not hold. For invariants, never for user
/// input.
template <class... Parts>
void require(bool condition, const Parts&... parts) {
  if (condition) return;
  std::ostringstream text;
  ((text << "internal error: ") << ... << parts);
  throw InternalError(text.str());
}

}  // namespace annulus
