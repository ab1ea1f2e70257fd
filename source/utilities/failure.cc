#include <alluvium/utilities/divergence.h>
#include <alluvium/utilities/failure.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/exceptions.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <new>
#include <regex>
#include <sstream>
#include <thread>

namespace alluvium
{
  namespace
  {
    /** deal.II's exceptions come with a page of text: what happened and where is enough. */
    std::string short_text(const dealii::ExceptionBase &exception)
    {
      std::ostringstream info;
      exception.print_info(info);
      std::string text = std::regex_replace(info.str(), std::regex("[ \t]*\n[ \t\n]*"), "\n  ");
      text.erase(0, text.find_first_not_of(" \n"));
      text.erase(text.find_last_not_of(" \n") + 1);

      const std::string name = exception.get_exc_name();
      std::cmatch       match;
      if (std::regex_search(exception.what(), match, std::regex("in line <(\\d+)> of file <([^>]*)>")))
        text += "\n  (" + name.substr(0, name.find('(')) + ", " +
                std::filesystem::path(match[2].str()).filename().string() + ":" + match[1].str() + ")";
      return text;
    }
  } // namespace


  Failure describe_failure(const std::exception_ptr &exception)
  {
    try
      {
        std::rethrow_exception(exception);
      }
    catch (const UserError &error)
      {
        return {mistake_of_user, error.what()};
      }
    catch (const Divergence &error)
      {
        return {diverged, error.what()};
      }
    catch (const dealii::ExceptionBase &error)
      {
        return {program_failed, short_text(error)};
      }
    catch (const std::filesystem::filesystem_error &error)
      {
        return {mistake_of_user, error.what()};
      }
    catch (const std::bad_alloc &)
      {
        return {program_failed, "the memory does not suffice: fewer cells or grains need less of it."};
      }
    catch (const std::exception &error)
      {
        return {program_failed, error.what()};
      }
    catch (...)
      {
        return {program_failed, "an unknown exception."};
      }
  }


  bool failed_together(MPI_Comm communicator, const std::string &message)
  {
    const unsigned long hash    = std::hash<std::string>()(message);
    const unsigned long mine[2] = {hash, ~hash};
    // outlive this function: where ranks are missing the reduction never ends
    static unsigned long largest[2];
    static unsigned long sent[2];
    std::copy(mine, mine + 2, sent);
    MPI_Request request;
    MPI_Iallreduce(sent, largest, 2, MPI_UNSIGNED_LONG, MPI_MAX, communicator, &request);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(3);
    int        done     = 0;
    while (MPI_Test(&request, &done, MPI_STATUS_IGNORE), done == 0)
      {
        if (std::chrono::steady_clock::now() > deadline)
          return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    return largest[0] == hash && largest[1] == ~hash;
  }
} // namespace alluvium
