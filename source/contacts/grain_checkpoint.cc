#include <alluvium/contacts/grain_checkpoint.h>
#include <alluvium/grains/grain_columns.h>
#include <alluvium/utilities/checked_file.h>
#include <alluvium/utilities/user_error.h>

#include <stdexcept>

namespace alluvium::contacts
{
  void save_grains(const MPI_Comm             communicator,
                   const std::string         &file_name,
                   const grains::GrainArrays &grains,
                   const ContactArchive      &contacts)
  {
    ByteWriter writer;
    writer.put(grains.id);
    for_each_column(grains, [&](const auto &values, const grains::GrainColumn &) { writer.put(values); });
    writer.put(contacts.dt);
    writer.put<std::uint64_t>(contacts.entries.size());
    for (const auto &entry : contacts.entries)
      {
        writer.put(entry.a);
        writer.put(entry.b);
        writer.put<std::uint8_t>(entry.wall);
        writer.put<std::uint8_t>(entry.bonded);
        writer.put(entry.rn);
        writer.put(entry.rt);
        writer.put(entry.rr);
      }
    writer.put(contacts.wall_positions);
    write_checked_file(communicator, file_name, "grains", writer.bytes);
  }


  void load_grains(const MPI_Comm       communicator,
                   const std::string   &file_name,
                   grains::GrainArrays &grains,
                   ContactArchive      &contacts)
  {
    const std::string bytes = read_checked_file(communicator, file_name, "grains");
    try
      {
        ByteReader reader(bytes);
        grains.id        = reader.get_vector<grains::GrainId>();
        bool same_length = true;
        for_each_column(grains, [&](auto &values, const grains::GrainColumn &) {
          values      = reader.get_vector<double>();
          same_length = same_length && values.size() == grains.id.size();
        });
        contacts.dt  = reader.get<double>();
        const auto n = reader.get<std::uint64_t>();
        contacts.entries.clear();
        for (std::uint64_t i = 0; i < n; ++i)
          {
            ContactArchive::Entry entry;
            entry.a      = reader.get<grains::GrainId>();
            entry.b      = reader.get<grains::GrainId>();
            entry.wall   = reader.get<std::uint8_t>() != 0;
            entry.bonded = reader.get<std::uint8_t>() != 0;
            entry.rn     = reader.get<double>();
            entry.rt     = reader.get<double>();
            entry.rr     = reader.get<double>();
            contacts.entries.push_back(entry);
          }
        contacts.wall_positions = reader.get_vector<double>();
        check_user(same_length && reader.at_end(), "'" + file_name + "' is not as this program writes it.");
      }
    catch (const std::runtime_error &)
      {
        throw UserError("'" + file_name + "' is not as this program writes it: was it made by another version?");
      }
  }
} // namespace alluvium::contacts
