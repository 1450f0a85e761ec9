// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The main function of a program that does one job.
 */
#ifndef Job_h
#define Job_h

#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

namespace benchmarks
{
/// Calls job(arguments without the program's name); what it throws is told on standard error.
template <typename Action>
int RunJob(int argc, char* argv[], std::size_t leastArguments, const char* usage, const Action& job)
{
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() < leastArguments)
  {
    std::cerr << "usage: " << argv[0] << " " << usage << "\n";
    return EXIT_FAILURE;
  }
  try
  {
    job(arguments);
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
}
}

#endif
