// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What the stages of a job cost: processor time of all threads, wall time, peak memory so far.
 *
 * The first stage, "start", is what the process did before main: loading its libraries.
 */
#ifndef StageClock_h
#define StageClock_h

#include <sys/resource.h>

#include <chrono>
#include <iostream>
#include <sstream>
#include <string>

namespace benchmarks
{
class StageClock
{
public:
  StageClock() { this->Finish("start"); }

  /// Ends a stage; the next one begins.
  void Finish(const std::string& stage)
  {
    const Reading now = Reading::Now();
    this->Stages << (this->Stages.tellp() > 0 ? ", " : "") << "{\"stage\": \"" << stage
                 << "\", \"cpu\": " << now.Cpu - this->Last.Cpu << ", \"wall\": "
                 << std::chrono::duration<double>(now.Wall - this->Last.Wall).count()
                 << ", \"peak_mb\": " << now.PeakMegabytes << "}";
    this->Last = now;
  }

  /// One line of JSON on standard output.
  void Print() const { std::cout << "{\"stages\": [" << this->Stages.str() << "]}" << std::endl; }

private:
  struct Reading
  {
    double Cpu = 0, PeakMegabytes = 0;
    std::chrono::steady_clock::time_point Wall = std::chrono::steady_clock::now();

    static Reading Now()
    {
      rusage used{};
      getrusage(RUSAGE_SELF, &used);
      const auto seconds = [](const timeval& t)
      { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
      return { seconds(used.ru_utime) + seconds(used.ru_stime),
        static_cast<double>(used.ru_maxrss) / 1024 };
    }
  };

  Reading Last;
  std::ostringstream Stages;
};
}

#endif
