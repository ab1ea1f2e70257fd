#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/contacts/step_start.h>
#include <alluvium/grains/grain_columns.h>

namespace alluvium::contacts
{
  namespace
  {
    void copy_changing_columns(const grains::GrainArrays &from, grains::GrainArrays &to)
    {
      for (const grains::GrainColumn &column : grains::grain_columns)
        if (column.when == grains::GrainColumn::When::changing)
          for (unsigned int c = 0; c < column.n_components; ++c)
            column.values(to, c) = column.values(from, c);
    }
  } // namespace


  void StepStart::remember(const grains::GrainArrays &grains, const ContactStepper &contacts)
  {
    copy_changing_columns(grains, before);
    memory = contacts.memory();
  }


  void StepStart::restore(grains::GrainArrays &grains, ContactStepper &contacts) const
  {
    contacts.restore(memory);
    copy_changing_columns(before, grains);
  }
} // namespace alluvium::contacts
