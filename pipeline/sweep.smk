# A sweep by Snakemake, on this machine or a cluster: the runs and the table of `mpm sweep`, a job a run.
#
#   snakemake -s pipeline/sweep.smk --cores 4 --config case=cases/tbar \
#       axes="['contacts[0].adhesion_factor=0,0.5,1', 'mesh.parameters.h=0.2,0.1']"
#
# On Slurm: pip install snakemake-executor-plugin-slurm, then --executor slurm --jobs 50 in place of --cores.
#
#   case    the case, as `mpm sweep` takes it
#   axes    its axes PATH=V1,V2,… as a list
#   set     entries PATH=VALUE of all runs, as a list [none]
#   folder  of the runs and table.csv [sweep/ beside the case]
#   mpm     the program [mpm on the path]
#
# A job that is killed, or ends at the limit of its time, goes on from its last checkpoint when it is started again
# (--rerun-incomplete). An analysis that could not go on is a result: the table has its reason.

import re
import shlex
import subprocess
from pathlib import Path

case = Path(config["case"])
axes = config["axes"] if isinstance(config["axes"], list) else [config["axes"]]
entries = config.get("set", [])
entries = entries if isinstance(entries, list) else [entries]
folder = Path(config.get("folder", (case if case.is_dir() else case.parent) / "sweep"))
sweep = [config.get("mpm", "mpm"), "sweep", str(case), *map(str, axes), "-o", str(folder)]
sweep += [word for entry in entries for word in ("--set", str(entry))]
runs = subprocess.run([*sweep, "--list"], check=True, capture_output=True, text=True).stdout.splitlines()
command = shlex.join(sweep).replace("{", "{{").replace("}", "}}")


rule table:
    input:
        expand("{folder}/.ended/{run}", folder=folder, run=runs),
    output:
        folder / "table.csv",
    shell:
        command + " --table"


rule run:
    output:
        touch(f"{folder}/.ended/{{run}}"),
    wildcard_constraints:
        run="|".join(map(re.escape, runs)),
    threads: 1
    shell:
        command + " --threads {threads} --only {wildcards.run:q} || [ $? -eq 1 ]"
