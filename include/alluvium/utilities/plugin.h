#pragma once

#include <alluvium/utilities/plugin_interface.h>
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
   * All known plug-ins of one kind, by the name that the parameter file uses. An Interface is derived from Plugin.
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

    static bool add(
      const std::string &name, const std::string &prose, std::function<std::unique_ptr<Interface>()> create)
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
  class PluginSet;

  /**
   * Second base of a plug-in that uses others of its kind. A PluginSet gives it its own instances of them, so that they
   * have the parameters that the user set in their sections; one made by the Registry alone has defaults.
   */
  template <class Interface>
  class Composite
  {
  public:
    virtual ~Composite() = default;

    /** Names of the plug-ins that it uses. They may depend on its own parameters. */
    virtual std::vector<std::string> parts() const = 0;

  protected:
    /** The plug-in named @p name, one of parts(). */
    Interface &part(const std::string &name) const
    {
      if (const auto it = shared.find(name); it != shared.end())
        return *it->second;
      std::unique_ptr<Interface> &instance = own[name];
      if (!instance)
        {
          const auto entry = Registry<Interface>::entries().find(name);
          check_user(entry != Registry<Interface>::entries().end(), "There is no plug-in named '" + name + "'.");
          instance = entry->second.create();
        }
      return *instance;
    }

  private:
    friend class PluginSet<Interface>;
    std::map<std::string, Interface *>                        shared;
    mutable std::map<std::string, std::unique_ptr<Interface>> own;
  };

  /** An instance of each registered plug-in, by name. Those that use others have them from here. */
  template <class Interface>
  class PluginSet
  {
  public:
    /** Create them; a second call does nothing. Throws UserError if two have the same name. */
    void create()
    {
      if (!instances.empty())
        return;
      check_user(names_taken().empty(),
                 "Two plug-ins of a kind have the same name, '" +
                   (names_taken().empty() ? std::string() : names_taken().front()) +
                   "'. One of the program's own cannot be replaced: name yours otherwise.");
      for (const auto &[key, entry] : Registry<Interface>::entries())
        instances.emplace(key, entry.create());
      for (const auto &[key, instance] : instances)
        if (auto *const composite = as_composite(*instance))
          for (const auto &[other, shared] : instances)
            if (other != key)
              composite->shared.emplace(other, shared.get());
    }

    /** Declare the parameters of each in a section of its own, "@p section: its name". */
    void add_parameters(dealii::ParameterHandler &prm, const std::string &section)
    {
      create();
      for (const auto &[key, instance] : instances)
        {
          prm.enter_subsection(section + ": " + key);
          instance->add_parameters(prm);
          prm.leave_subsection();
        }
    }

    /** Parse the parameters of the plug-in @p name, and of those that it uses. */
    void parse_parameters(const std::string &name) const
    {
      std::vector<std::string> users;
      parse(name, users);
    }

    bool empty() const { return instances.empty(); }

    /** All names, in single quotation marks or as they are. */
    std::string names(const std::string &separator, const bool quoted = false) const
    {
      std::string result;
      for (const auto &[key, instance] : instances)
        result += (result.empty() ? "" : separator) + (quoted ? "'" + key + "'" : key);
      return result;
    }

    bool contains(const std::string &name) const { return instances.count(name) > 0; }

    const std::shared_ptr<Interface> &get(const std::string &name) const
    {
      const auto it = instances.find(name);
      check_user(it != instances.end(), "There is no plug-in named '" + name + "'.");
      return it->second;
    }

    const std::map<std::string, std::shared_ptr<Interface>> &all() const { return instances; }

  private:
    std::map<std::string, std::shared_ptr<Interface>> instances;

    static Composite<Interface> *as_composite(Interface &plugin)
    {
      return dynamic_cast<Composite<Interface> *>(&plugin);
    }

    void parse(const std::string &name, std::vector<std::string> &users) const
    {
      Interface &plugin = *get(name);
      plugin.parse_parameters();
      const auto *const composite = as_composite(plugin);
      if (!composite)
        return;
      users.push_back(name);
      for (const std::string &part : composite->parts())
        {
          check_user(contains(part), "'" + name + "' uses '" + part + "', but there is no plug-in of this name.");
          for (const std::string &user : users)
            check_user(user != part, "'" + name + "' uses '" + part + "', which uses '" + name + "'.");
          parse(part, users);
        }
      users.pop_back();
    }
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
      if (plugins.empty())
        selected = choice;
      plugins.create();
      const std::string names = plugins.names("|");
      std::string       text  = prose;
      for (const auto &[key, entry] : Registry<Interface>::entries())
        text += "\n'" + key + "': " + entry.prose;
      if (several)
        prm.add_parameter(name, selected, text, dealii::Patterns::MultipleSelection(names));
      else
        prm.add_parameter(name, selected, text, dealii::Patterns::Selection(names));
      plugins.add_parameters(prm, name);
    }

    /** Of those that are chosen, and of those that they use. */
    void parse_parameters() const
    {
      for (const auto &key : dealii::Utilities::split_string_list(selected, ','))
        plugins.parse_parameters(key);
    }

    const std::string &name() const { return selected; }

    Interface &get() const { return get(selected); }

    Interface &get(const std::string &plugin) const { return *plugins.get(plugin); }

    /** The chosen plug-ins in the order given, for a choice of several. */
    std::vector<Interface *> all() const
    {
      std::vector<Interface *> result;
      for (const auto &key : dealii::Utilities::split_string_list(selected, ','))
        result.push_back(&get(key));
      return result;
    }

  private:
    std::string          selected;
    PluginSet<Interface> plugins;
  };
} // namespace alluvium
