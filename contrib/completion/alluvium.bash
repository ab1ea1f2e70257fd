# Completion for bash: options, scenes, sections, parameters, and their values where they are a choice.
#   source contrib/completion/alluvium.bash     in ~/.bashrc, or copied as `alluvium` to /usr/share/bash-completion/completions
#
#   alluvium --set 'Coup<TAB>        Coupling/
#   alluvium --set 'Coupling/Dr<TAB> Drag law=, Drag law: disc/, ...
#
# Names come from the program that is typed. They are kept in ~/.cache/alluvium, until that program changes, and for when there is none.

# One line a parameter: its path, its default, and the values that it may have, separated by commas, if it is a choice; with tabs between.
_alluvium_list() {
  "$1" --print-parameters 2>/dev/null | awk '
    /^ *#/ { sub(/^ *# ?/, ""); prose = prose " " $0; next }
    /^ *subsection / { sub(/^ *subsection /, ""); section[++depth] = $0; prose = ""; next }
    /^ *end$/ { --depth; next }
    /^ *set / {
      sub(/^ *set /, ""); standard = $0; sub(/ *=.*/, ""); sub(/^[^=]*= */, "", standard)
      path = ""; for (i = 1; i <= depth; ++i) path = path section[i] "/"
      values = ""
      if (match(prose, /Allowed: (one of|any of these, separated by commas): .*$/)) {
        values = substr(prose, RSTART, RLENGTH); sub(/^Allowed: (one of|any of these, separated by commas): /, "", values)
        gsub(/, */, ",", values)
      } else if (prose ~ /Allowed: true or false/) values = "true,false"
      print path $0 "\t" (standard == "" ? "..." : standard) "\t" values
      prose = ""
    }'
}

# The file that has them; fails if there is no program and none was ever asked.
_alluvium_parameters() {
  local program folder=${XDG_CACHE_HOME:-$HOME/.cache}/alluvium list
  list=$folder/parameters
  program=$(type -P -- "$1")
  # the file is as old as the program it comes from: built again, or another one, it is asked again
  if [ -n "$program" ] && { [ ! -s "$list" ] || [ "$program" -nt "$list" ] || [ "$program" -ot "$list" ]; }; then
    mkdir -p "$folder" 2>/dev/null
    local new
    new=$(_alluvium_list "$program")
    if [ -n "$new" ]; then
      printf '%s\n' "$new" 2>/dev/null >"$list.$$" && touch -r "$program" "$list.$$" && mv -f "$list.$$" "$list"
    fi
  fi
  [ -s "$list" ] && echo "$list"
}

# What follows --set: candidates for the name, or for the value if there is a `=` already. A single one would make bash close the
# quotes, so what is not yet complete goes on: a section with what is in it, a name with the parameter's default.
_alluvium_set() {
  local typed=$1 list path standard values value rest
  list=$(_alluvium_parameters "$2") || return
  while [ ${#COMPREPLY[@]} -le 1 ]; do
    COMPREPLY=()
    while IFS=$'\t' read -r path standard values; do
      if [[ $typed == "$path="* ]]; then # a value; of several, the last
        rest=${typed#"$path="}
        if [ -z "$values" ]; then
          [ -n "$rest" ] || COMPREPLY=("$typed" "$typed$standard")
          return
        fi
        [[ $rest == *,* ]] && rest="${rest%,*}," || rest=
        local IFS=,
        for value in $values; do
          [[ "$path=$rest$value" == "$typed"* ]] && COMPREPLY+=("$path=$rest$value")
        done
        return
      elif [[ $path == "$typed"* ]]; then # up to the next slash, as folders are
        rest=${path#"$typed"}
        [[ $rest == */* ]] && COMPREPLY+=("$typed${rest%%/*}/") || COMPREPLY+=("$path=")
      fi
    done <"$list"
    [ ${#COMPREPLY[@]} -gt 0 ] || return
    mapfile -t COMPREPLY < <(printf '%s\n' "${COMPREPLY[@]}" | sort -u)
    typed=${COMPREPLY[0]}
  done
}

_alluvium() {
  local line=${COMP_LINE:0:COMP_POINT} current=${COMP_WORDS[COMP_CWORD]} raw typed quoted= break
  COMPREPLY=()
  if [[ $line =~ [[:space:]]--set[[:space:]]+((\'[^\']*\'|\"[^\"]*\"|\\.|[^[:space:]\\\'\"])*(\'[^\']*|\"[^\"]*)?)$ ]]; then
    raw=${BASH_REMATCH[1]}
    case $raw in
      \'* | \"*) quoted=1 typed=${raw:1} ;;
      *) typed=${raw//\\/} ;;
    esac
    compopt -o filenames -o nospace # which quotes blanks, and shows what is after the last slash
    _alluvium_set "$typed" "$1"
    # readline replaces what is after the last `:` or `=`, unless that is quoted
    if [ -z "$quoted" ] && [[ $raw =~ ^(.*[^\\][:=]) ]]; then
      break=${BASH_REMATCH[1]//\\/}
      COMPREPLY=("${COMPREPLY[@]#"$break"}")
    fi
  elif [[ $current == -* ]]; then
    local options='--check --print-parameters --set --version --help' found
    found=$("$1" --help 2>/dev/null | grep -oE -- '--[a-z][a-z-]*' | sort -u)
    mapfile -t COMPREPLY < <(compgen -W "${found:-$options}" -- "$current")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -X '!*.prm' -- "$current"; compgen -d -- "$current")
  fi
}

complete -F _alluvium alluvium
