#include "master/script/confine.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <cerrno>
#include <system_error>

namespace rayfarm {
namespace {

void require(int result, const char* what) {
  if (result != 0) throw std::system_error(errno, std::generic_category(), what);
}

void set_hard_limit(__rlimit_resource resource, rlim_t most) {
  const rlimit limit{most, most};
  require(setrlimit(resource, &limit), "setrlimit");
}

}  // namespace

void confine(std::uint64_t address_space_bytes) {
  require(prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0), "prctl");
  require(prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), "prctl");
  require(prctl(PR_SET_DUMPABLE, 0, 0, 0, 0), "prctl");
  set_hard_limit(RLIMIT_CORE, 0);
  set_hard_limit(RLIMIT_FSIZE, 0);
  set_hard_limit(RLIMIT_NPROC, 0);
#ifndef __SANITIZE_ADDRESS__  // sanitizers reserve terabytes of addresses, and look at memory through pipes
  set_hard_limit(RLIMIT_NOFILE, 0);
  set_hard_limit(RLIMIT_AS, address_space_bytes);
#else
  (void)address_space_bytes;
#endif
}

void limit_cpu(std::uint32_t seconds) {
  const rlimit limit{seconds, RLIM_INFINITY};
  require(setrlimit(RLIMIT_CPU, &limit), "setrlimit");
}

}  // namespace rayfarm
