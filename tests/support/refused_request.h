#pragma once

#include <gtest/gtest.h>

#include <string>

#include "timbre/analysis/core/error.h"

namespace timbre {

/// The whole error line of a call that must be refused as a bad request.
template <typename Call>
std::string refused_request(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_request);
    return error.what();
  }
  return "no error";
}

}  // namespace timbre
