#include "master/script/confine.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace rayfarm {
namespace {

void require(int result, const char* what) {
  if (result != 0) throw std::system_error(errno, std::generic_category(), what);
}

/// Lowers a limit; one that is lower already (ulimit, a service's limits) stays as it is.
void lower_limit(__rlimit_resource resource, rlim_t soft, rlim_t hard) {
  rlimit limit{};
  require(getrlimit(resource, &limit), "getrlimit");
  limit.rlim_max = std::min(limit.rlim_max, hard);
  limit.rlim_cur = std::min({limit.rlim_cur, soft, limit.rlim_max});
  require(setrlimit(resource, &limit), "setrlimit");
}

}  // namespace

void confine(std::uint64_t address_space_bytes) {
  require(prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0), "prctl");
  require(prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), "prctl");
  require(prctl(PR_SET_DUMPABLE, 0, 0, 0, 0), "prctl");
  lower_limit(RLIMIT_CORE, 0, 0);
  lower_limit(RLIMIT_FSIZE, 0, 0);
  lower_limit(RLIMIT_NPROC, 0, 0);
#ifndef RAYFARM_SANITIZED  // sanitizers reserve terabytes of addresses, and look at memory through pipes
  lower_limit(RLIMIT_NOFILE, 0, 0);
  lower_limit(RLIMIT_AS, address_space_bytes, address_space_bytes);
#else
  (void)address_space_bytes;
#endif
}

void limit_cpu(std::uint32_t seconds) { lower_limit(RLIMIT_CPU, seconds, RLIM_INFINITY); }

}  // namespace rayfarm
