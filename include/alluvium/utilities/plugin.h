#pragma once

#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace alluvium
{
  /** How many plug-ins have been registered: by this a library that was loaded shows that it has some. */
  [[gnu::visibility("default")]] inline unsigned int &n_registered_plugins()
  {
    static unsigned int n = 0;
    return n;
  }

  /** Names that were registered more than once for a kind. Said later: before main() there is nobody to say it to. */
  [[gnu::visibility("default")]] inline std::vector<std::string> &names_taken()
  {
    static std::vector<std::string> names;
    return names;
  }

  /**
   * All known plug-ins of one kind, by the name that the parameter file uses. An Interface has a virtual destructor and
   * `void add_parameters(dealii::ParameterHandler &)`, which declares its parameters and binds them to its members.
   */
  template <class Interface>
  class [[gnu::visibility("default")]] Registry // one for the program and all libraries, whatever these hide
  {
  public:
    struct Entry
    {
      std::string                                 prose;
      std::function<std::unique_ptr<Interface>()> create;
    };

    static std::map<std::string, Entry> &entries()
    {
      static std::map<std::string, Entry> all;
      return all;
    }

    static bool
    add(const std::string &name, const std::string &prose, std::function<std::unique_ptr<Interface>()> create)
    {
      const bool is_new = entries().emplace(name, Entry{prose, std::move(create)}).second;
      if (is_new)
        ++n_registered_plugins();
      else
        names_taken().push_back(name);
      return is_new;
    }
  };

  /**
   * Register @p Class as a plug-in of kind @p Interface. Write it once, at namespace scope in the plug-in's own .cc;
   * no other file needs to know.
   */
#define ALLUVIUM_REGISTER(Interface, Class, name, prose)                                                               \
  namespace                                                                                                            \
  {                                                                                                                    \
    [[maybe_unused]] const bool registered_##Class =                                                                   \
      ::alluvium::Registry<Interface>::add(name, prose, [] { return std::make_unique<Class>(); });                     \
  }

  template <class Interface>
  class PluginChoice;

  /**
   * Second base of a plug-in that uses others of its kind. PluginChoice gives it its own instances of them, so that
   * they have the parameters that the user set in their sections; one made by the Registry alone has defaults.
   */
  template <class Interface>
  class Composite
  {
  public:
    virtual ~Composite() = default;

  protected:
    /** The plug-in named @p name, which must be registered. */
    Interface &part(const std::string &name) const
    {
      if (const auto it = shared.find(name); it != shared.end())
        return *it->second;
      std::unique_ptr<Interface> &instance = own[name];
      if (!instance)
        instance = Registry<Interface>::entries().at(name).create();
      return *instance;
    }

  private:
    friend class PluginChoice<Interface>;
    std::map<std::string, Interface *>                        shared;
    mutable std::map<std::string, std::unique_ptr<Interface>> own;
  };

  /**
   * One plug-in chosen by name, or several. Declares the choice and a subsection with each registered plug-in's own
   * parameters (a plug-in without parameters leaves no trace), so that --print-parameters shows them all by themselves.
   */
  template <class Interface>
  class PluginChoice
  {
  public:
    /**
     * Declare parameter @p name with default @p choice and explanation @p prose in the current section of @p prm. A
     * second call binds its @p prm to the same instances, with what they have now as defaults.
     */
    void add_parameters(dealii::ParameterHandler &prm,
                        const std::string        &name,
                        const std::string        &choice,
                        const std::string        &prose,
                        const bool                several = false)
    {
      if (instances.empty())
        create_all(choice);
      std::string names, text = prose;
      for (const auto &[key, entry] : Registry<Interface>::entries())
        {
          names += (names.empty() ? "" : "|") + key;
          text += "\n'" + key + "': " + entry.prose;
        }
      if (several)
        prm.add_parameter(name, selected, text, dealii::Patterns::MultipleSelection(names));
      else
        prm.add_parameter(name, selected, text, dealii::Patterns::Selection(names));
      for (const auto &[key, instance] : instances)
        {
          prm.enter_subsection(name + ": " + key);
          instance->add_parameters(prm);
          prm.leave_subsection();
        }
    }

    const std::string &name() const { return selected; }

    Interface &get() const { return get(selected); }

    Interface &get(const std::string &plugin) const
    {
      const auto it = instances.find(plugin);
      check_user(it != instances.end(), "There is no plug-in named '" + plugin + "'.");
      return *it->second;
    }

    /** The chosen plug-ins in the order given, for a choice of several. */
    std::vector<Interface *> all() const
    {
      std::vector<Interface *> result;
      for (const auto &key : dealii::Utilities::split_string_list(selected, ','))
        result.push_back(&get(key));
      return result;
    }

  private:
    std::string                                       selected;
    std::map<std::string, std::unique_ptr<Interface>> instances;

    void create_all(const std::string &choice)
    {
      selected = choice;
      check_user(names_taken().empty(),
                 "Two plug-ins of a kind have the same name, '" +
                   (names_taken().empty() ? std::string() : names_taken().front()) +
                   "'. One of the program's own cannot be replaced: name yours otherwise.");
      for (const auto &[key, entry] : Registry<Interface>::entries())
        instances.emplace(key, entry.create());
      for (const auto &[key, instance] : instances)
        if (auto *const composite = dynamic_cast<Composite<Interface> *>(instance.get()))
          for (const auto &[other, shared] : instances)
            if (other != key)
              composite->shared.emplace(other, shared.get());
    }
  };
} // namespace alluvium
