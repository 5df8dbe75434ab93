// The journal's file, damaged: a master starts with it, shows what is left, and writes on.
#include "master/farm.h"
#include "master/journal/journal.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {

void fuzz(ByteView bytes) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "journal.db";
  put_content(file, std::string(text_of(bytes)));
  try {
    Journal journal(file);
    const Journal::Opened opened = journal.read();
    Farm farm(FarmLimits{}, opened.past, opened.latest);
    for (const JobView& job : farm.jobs(opened.latest)) farm.film(job.id);
    for (const auto records = farm.take_records(); !journal.write(records);) {}
    for (const JobView& job : farm.jobs(opened.latest))
      farm.resume(job.id, opened.latest), farm.remove(job.id);
    for (const auto records = farm.take_records(); !journal.write(records);) {}
    journal.tidy();
  } catch (const JournalError&) {}
}

}  // namespace rayfarm
