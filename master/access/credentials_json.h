// Credentials as the text that is kept of them.
#pragma once
#include <string>

#include "master/access/credentials.h"

namespace rayfarm {

std::string json_of(const Credentials& credentials);
/// Throws std::runtime_error that says where the text is not what json_of() gives.
Credentials credentials_in(const std::string& json);

}  // namespace rayfarm
