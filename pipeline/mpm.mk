# Make rules for the four stages of every case, to include from any project:
#
#   CASES := my_slope sweep/a sweep/b     # folders with a case.yaml; default: all below cases/
#   MPM   := /path/to/mpm                 # default: mpm on the path
#   include /path/to/pipeline/mpm.mk
#
# gives, for a case in the folder sweep/a, the targets a (all four stages), a-mesh, a-seed, a-solve, a-export
# and a-clean. `mpm run` finds by the contents of all files which stages are stale, so `make -j` does these and no more,
# several cases at a time. Results are under <case>/out.
#
#   make a RESUME=1       takes up a solve that was stopped at its last checkpoint
#   make a FRESH=1        gives up a solve that was stopped, and begins anew
#   make a THREADS=1      threads of a solve (with `make -j4`, let -j and THREADS share the cores)
#   make a MPM_FLAGS='--set mesh.parameters.h=0.2'
#
# What stands in a case is for the program alone: make and the shell see the names of folders and no more.

MPM   ?= mpm
CASES ?= $(patsubst %/case.yaml,%,$(wildcard cases/*/case.yaml))

# Folders whose names have a character that make or the shell would obey are left out.
mpm_comma := ,
mpm_hash := \#
mpm_obeyed := ! " $(mpm_hash) $$ % & ' ( ) * : ; < = > ? [ \ ] ` { | } ~ $(mpm_comma)
mpm_is_plain = $(if $(filter -%,$(1)),,$(if $(strip $(foreach c,$(mpm_obeyed),$(findstring $(c),$(1)))),,yes))
mpm_all := $(CASES)
override CASES := $(foreach case,$(mpm_all),$(if $(call mpm_is_plain,$(case)),$(case)))
ifneq ($(words $(CASES)),$(words $(mpm_all)))
$(warning folders of cases whose names have other characters than letters, digits, `.`, `_`, `+`, `@` and `-` are left out: rename them)
endif

mpm_names := $(notdir $(CASES))
# The folder of a target: its name without the stage is the last part of one.
mpm_folder = '$(firstword $(foreach case,$(CASES),$(if $(filter $(notdir $(case)),$(1)),$(case))))'
# Where the program is a file, or is built by a target MPM_BUILD, it is there before it is needed.
mpm_program := $(or $(MPM_BUILD),$(wildcard $(firstword $(MPM))))
mpm_solve_flags = $(if $(RESUME),--resume) $(if $(FRESH),--fresh) $(if $(THREADS),--threads $(THREADS))

.PHONY: $(mpm_names) $(foreach stage,mesh seed solve export clean,$(addsuffix -$(stage),$(mpm_names)))

# A project may add to what the target of a case does.
$(mpm_names): %: %-export

# The stages of a case, one after the other also where several are asked for.
$(addsuffix -mesh,$(mpm_names)): %-mesh: $(mpm_program)
	$(MPM) run $(call mpm_folder,$*) --until mesh $(MPM_FLAGS)
$(addsuffix -seed,$(mpm_names)): %-seed: %-mesh
	$(MPM) run $(call mpm_folder,$*) --until seed $(MPM_FLAGS)
$(addsuffix -solve,$(mpm_names)): %-solve: %-seed
	$(MPM) run $(call mpm_folder,$*) --until solve $(mpm_solve_flags) $(MPM_FLAGS)
$(addsuffix -export,$(mpm_names)): %-export: %-solve
	$(MPM) run $(call mpm_folder,$*) --until export $(MPM_FLAGS)

$(addsuffix -clean,$(mpm_names)): %-clean:
	rm -rf $(call mpm_folder,$*)/out
