#include <alluvium/utilities/atomic_file.h>
#include <alluvium/utilities/checked_file.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>

#include <boost/crc.hpp>

#include <cstring>
#include <fstream>
#include <sstream>
#include <tuple>

namespace alluvium
{
  using namespace dealii;

  namespace
  {
    std::string header(const std::string &kind, const std::string &payload)
    {
      std::ostringstream text;
      text << "alluvium " << kind << " 1 " << payload.size() << " " << std::hex << crc32(payload) << "\n";
      return text.str();
    }

    /** Read on one rank: (payload, complaint). */
    std::pair<std::string, std::string> read(const std::string &file_name, const std::string &kind)
    {
      std::ifstream file(file_name, std::ios::binary);
      if (!file)
        return {"", "cannot be opened."};
      std::string first, word, found_kind;
      std::getline(file, first);
      int                version = 0;
      unsigned long long size    = 0;
      std::istringstream line(first);
      line >> word >> found_kind >> version >> size;
      if (!line || word != "alluvium" || found_kind != kind)
        return {"", "is no Alluvium file of the kind '" + kind + "', or it is damaged."};
      if (version != 1)
        return {"", "has version " + std::to_string(version) + "; this program reads version 1."};
      std::ostringstream rest;
      rest << file.rdbuf();
      std::string payload = rest.str();
      if (payload.size() < size)
        return {"",
                "is cut off: it holds " + std::to_string(payload.size()) + " of " + std::to_string(size) + " bytes."};
      if (header(kind, payload) != first + "\n")
        return {"", "is damaged: its checksum does not match."};
      return {payload, ""};
    }
  } // namespace


  std::uint32_t crc32(const std::string &data)
  {
    boost::crc_32_type crc;
    crc.process_bytes(data.data(), data.size());
    return crc.checksum();
  }


  void write_checked_file(const MPI_Comm     communicator,
                          const std::string &file_name,
                          const std::string &kind,
                          const std::string &payload)
  {
    std::string complaint;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      try
        {
          write_atomically(file_name, header(kind, payload) + payload);
        }
      catch (const UserError &error)
        {
          complaint = error.what();
        }
    complaint = Utilities::MPI::broadcast(communicator, complaint);
    check_user(complaint.empty(), complaint);
  }


  std::string read_checked_file(const MPI_Comm communicator, const std::string &file_name, const std::string &kind)
  {
    std::string payload, complaint;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      std::tie(payload, complaint) = read(file_name, kind);
    complaint = Utilities::MPI::broadcast(communicator, complaint);
    check_user(complaint.empty(), "'" + file_name + "' " + complaint);
    return Utilities::MPI::broadcast(communicator, payload);
  }


  void ByteReader::check_room(const std::uint64_t count, const std::size_t size) const
  {
    if (count > (bytes->size() - position) / size)
      throw std::runtime_error("A vector is longer than the bytes that should hold it.");
  }


  void ByteReader::take(void *to, const std::size_t size)
  {
    if (size > bytes->size() - position)
      throw std::runtime_error("Reading beyond the end of the bytes.");
    if (size > 0)
      std::memcpy(to, bytes->data() + position, size);
    position += size;
  }
} // namespace alluvium
