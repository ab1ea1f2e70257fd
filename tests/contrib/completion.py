#!/usr/bin/python3
"""contrib/completion/alluvium.bash, in a bash on a terminal of its own: what stands on the line after a TAB."""

import os
import pty
import select
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = os.path.abspath(sys.argv[1])


class Bash:
    def __init__(self, folder, path):
        self.line = os.path.join(folder, "line")
        # the home is empty, so that no cache is there
        environment = {"HOME": folder, "PATH": path, "TERM": "dumb", "PS1": "$ ", "OMP_NUM_THREADS": "1", "INPUTRC": "/dev/null"}
        self.pid, self.terminal = pty.fork()
        if self.pid == 0:
            os.chdir(folder)
            os.execve("/bin/bash", ["bash", "--norc", "--noprofile", "-i"], environment)
        self.send("bind 'set bell-style none'; bind 'set show-all-if-ambiguous on'\n")
        self.send("bind -x '\"\\C-xl\": printf %%s \"$READLINE_LINE\" >%s'\n" % self.line)
        self.send("source %s/contrib/completion/alluvium.bash\n" % ROOT)

    def send(self, text):
        os.write(self.terminal, text.encode())
        return self.read(0.2)

    def read(self, silence):
        out = b""
        while select.select([self.terminal], [], [], silence)[0]:
            out += os.read(self.terminal, 4096)
        return out.decode(errors="replace")

    def complete(self, text):
        """(line after a TAB, what was printed meanwhile)"""
        if os.path.exists(self.line):
            os.remove(self.line)
        os.write(self.terminal, text.encode() + b"\t\x18l")
        printed, end = "", time.time() + 30
        while not os.path.exists(self.line) and time.time() < end:
            printed += self.read(0.1)
        printed += self.read(0.1)  # what came before the line was written, if that was quick
        with open(self.line) as file:
            line = file.read()
        self.send("\x15")
        return line, printed

    def close(self):
        os.close(self.terminal)
        os.waitpid(self.pid, 0)


def check(bash, text, expected, printed=()):
    line, out = bash.complete(text)
    if line != expected or any(word not in out for word in printed):
        sys.exit("%r became %r, not %r; printed: %r" % (text, line, expected, out))


with tempfile.TemporaryDirectory() as folder:
    os.symlink(PROGRAM, os.path.join(folder, "alluvium"))
    os.mkdir(os.path.join(folder, "scenes"))
    for name in ("bed.prm", "bed.csv", "scenes/other.prm", "two words.prm"):
        open(os.path.join(folder, name), "w").close()

    bash = Bash(folder, folder + ":/usr/bin:/bin")
    # options: those of --help
    check(bash, "alluvium --ch", "alluvium --check ")
    check(bash, "alluvium --pri", "alluvium --print-parameters ")
    check(bash, "./alluvium --s", "./alluvium --set ")
    # scenes, and folders that may have some
    check(bash, "alluvium be", "alluvium bed.prm ")
    check(bash, "alluvium --check sce", "alluvium --check scenes/")
    check(bash, "alluvium tw", "alluvium two\\ words.prm ")
    # sections and names in quotes, which is how they are written
    check(bash, "alluvium bed.prm --set 'Tim", "alluvium bed.prm --set 'Time/")
    check(bash, "alluvium --set 'Time/End", "alluvium --set 'Time/End time=")
    check(bash, 'alluvium --set "Grains/Deposit: set', 'alluvium --set "Grains/Deposit: settled bed/')
    check(bash, "alluvium --set 'Grains/Deposit: settled bed/Num", "alluvium --set 'Grains/Deposit: settled bed/Number of grains=")
    check(bash, "alluvium --set 'Coupling/Drag law", "alluvium --set 'Coupling/Drag law", ["Drag law: disc/", "Drag law="])
    check(bash, "alluvium --set 'Met", "alluvium --set 'Method=")
    # a second --set, after one that is complete
    check(bash, "alluvium --set 'Time/End time=1' --set 'Flu", "alluvium --set 'Time/End time=1' --set 'Fluid/")
    # values where they are a choice, one or several
    check(bash, "alluvium --set 'Coupling/Drag law=Gi", "alluvium --set 'Coupling/Drag law=Gidaspow'")
    check(bash, "alluvium --set 'Grains/Fixed=t", "alluvium --set 'Grains/Fixed=true'")
    check(bash, "alluvium --set 'Output/Observers=audit,en", "alluvium --set 'Output/Observers=audit,energy'")
    check(bash, "alluvium --set 'Time/End time=1", "alluvium --set 'Time/End time=1")
    # without quotes: blanks get a backslash
    for text, expected in (("Tim", "Time/"), ("Time/End", "Time/End time="), ("Grains/Deposit:", "Grains/Deposit: "),
                           ("Coupling/Drag\\ law=Gi", "Coupling/Drag law=Gidaspow")):
        line, out = bash.complete("alluvium --set " + text)
        words = subprocess.run(["bash", "-c", "set -- %s; printf '%%s' \"$3\"" % line], stdout=subprocess.PIPE, text=True).stdout
        assert words.rstrip() == expected.rstrip(), (text, line, words, out)
    check(bash, "alluvium --set 'No such", "alluvium --set 'No such")
    bash.close()

    # kept for when there is no program
    assert os.path.getsize(os.path.join(folder, ".cache/alluvium/parameters")) > 5000
    os.remove(os.path.join(folder, "alluvium"))
    bash = Bash(folder, "/usr/bin:/bin")
    check(bash, "alluvium --set 'Time/End", "alluvium --set 'Time/End time=")
    check(bash, "alluvium --ch", "alluvium --check ")
    bash.close()

    # every parameter of the program is in the list
    with open(os.path.join(folder, ".cache/alluvium/parameters")) as file:
        listed = [line.split("\t")[0].rsplit("/", 1)[-1] for line in file]
    printed = subprocess.run([PROGRAM, "--print-parameters"], stdout=subprocess.PIPE, text=True).stdout
    names = [line.split("=")[0].strip()[4:] for line in printed.splitlines() if line.strip().startswith("set ")]
    assert listed == [name.strip() for name in names], set(listed) ^ set(names)
    print("%d parameters" % len(names))
