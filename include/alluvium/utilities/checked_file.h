#pragma once

#include <mpi.h>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace alluvium
{
  /** CRC-32 (as in zip) of @p data. */
  std::uint32_t crc32(const std::string &data);

  /**
   * Write a file of @p kind (one word, e.g. "grains") with length and checksum of @p payload in its first line. Rank 0
   * writes, to a temporary name first. Throws UserError on all ranks if the disk does not take it. Collective.
   */
  void write_checked_file(MPI_Comm           communicator,
                          const std::string &file_name,
                          const std::string &kind,
                          const std::string &payload);

  /**
   * The payload of a file by write_checked_file(), on all ranks. Throws UserError, naming the file, on all ranks if it
   * is missing, not of this @p kind, cut off or altered. Collective; rank 0 reads.
   */
  std::string read_checked_file(MPI_Comm communicator, const std::string &file_name, const std::string &kind);

  /** Appends numbers and vectors of numbers to a string, byte by byte. */
  class ByteWriter
  {
  public:
    template <typename T>
    void put(const T value)
    {
      static_assert(std::is_arithmetic_v<T>);
      bytes.append(reinterpret_cast<const char *>(&value), sizeof(T));
    }

    template <typename T>
    void put(const std::vector<T> &values)
    {
      static_assert(std::is_arithmetic_v<T>);
      put<std::uint64_t>(values.size());
      bytes.append(reinterpret_cast<const char *>(values.data()), values.size() * sizeof(T));
    }

    void put(const std::string &text)
    {
      put<std::uint64_t>(text.size());
      bytes += text;
    }

    std::string bytes;
  };

  /** Reads what ByteWriter wrote, in the same order; throws std::runtime_error beyond the end. */
  class ByteReader
  {
  public:
    explicit ByteReader(const std::string &bytes)
      : bytes(&bytes)
    {}

    template <typename T>
    T get()
    {
      static_assert(std::is_arithmetic_v<T>);
      T value;
      take(&value, sizeof(T));
      return value;
    }

    template <typename T>
    std::vector<T> get_vector()
    {
      const auto size = get<std::uint64_t>();
      check_room(size, sizeof(T));
      std::vector<T> values(size);
      take(values.data(), size * sizeof(T));
      return values;
    }

    std::string get_string()
    {
      const auto size = get<std::uint64_t>();
      check_room(size, 1);
      std::string text(size, '\0');
      take(text.data(), size);
      return text;
    }

    bool at_end() const { return position == bytes->size(); }

  private:
    void check_room(std::uint64_t count, std::size_t size) const;
    void take(void *to, std::size_t size);

    const std::string *bytes;
    std::size_t        position = 0;
  };
} // namespace alluvium
