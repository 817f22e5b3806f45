// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The kernel as a plugin sees it, and how errors travel: inside a plugin as exceptions, across the boundary as a
// status with a text. `guarded` stands at every callback, so that no exception ever crosses.
#pragma once

#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

#include "shoal/abi.h"

namespace shoal {

// What the user asked for cannot be done; the text says how to mend it.
struct CaseError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The run left what the model can describe.
struct PhysicsFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

namespace impl {

inline const shoal_host* host_table = nullptr;

// A call of the host failed, and its text is already known to the host.
struct HostFailed : std::exception {
  explicit HostFailed(shoal_status s) : status(s) {}
  const char* what() const noexcept override { return "the kernel refused a call"; }
  shoal_status status;
};

}  // namespace impl

// A copy of a struct that the kernel made: members that it did not know are zero, those that we do not know are left.
template <class Struct>
Struct copy_of(const Struct& made) {
  Struct copy{};
  std::memcpy(static_cast<void*>(&copy), &made, made.size < sizeof(Struct) ? made.size : sizeof(Struct));
  copy.size = sizeof(Struct);
  return copy;
}

inline const shoal_host& host() { return *impl::host_table; }

inline void check_host(shoal_status status) {
  if (status != SHOAL_OK) throw impl::HostFailed(status);
}

inline void log_debug(const std::string& text) { host().log(SHOAL_LOG_DEBUG, text.c_str()); }
inline void log_info(const std::string& text) { host().log(SHOAL_LOG_INFO, text.c_str()); }
inline void log_warning(const std::string& text) { host().log(SHOAL_LOG_WARNING, text.c_str()); }

// Ends the run behind this outer step, because it has come to what it is for; outputs and probes are sampled once more.
inline void finish_run(const std::string& reason) {
  if (SHOAL_HAS(shoal_host, &host(), finish))
    host().finish(reason.c_str());
  else
    log_warning(reason + "; this version of Shoal cannot end a run before its time");
}

// Runs a callback; turns its exceptions into a status and a text.
template <class Callback>
shoal_status guarded(Callback&& callback) noexcept {
  try {
    std::forward<Callback>(callback)();
    return SHOAL_OK;
  } catch (const impl::HostFailed& failed) {
    return failed.status;
  } catch (const CaseError& error) {
    host().fail(error.what());
    return SHOAL_CASE_ERROR;
  } catch (const PhysicsFailed& error) {
    host().fail(error.what());
    return SHOAL_PHYSICS_FAILED;
  } catch (const std::exception& error) {
    host().fail(error.what());
  } catch (...) {
    host().fail("an exception of unknown type");
  }
  return SHOAL_ERROR;
}

}  // namespace shoal
