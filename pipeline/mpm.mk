# Make rules for the four stages of every case, to include from any project:
#
#   CASES := my_slope sweep/a sweep/b     # folders with a case.yaml; default: all below cases/
#   MPM   := /path/to/mpm                 # default: mpm on the path
#   include /path/to/pipeline/mpm.mk
#
# gives, for a case in the folder sweep/a, the targets a (all four stages), a-mesh, a-seed, a-solve, a-export
# and a-clean. A stage runs only where its inputs are newer than its output, so `make -j` rebuilds what is
# stale and no more, several cases at a time. Results are under <case>/out.
#
#   make a RESUME=1       takes up a solve that was stopped at its last checkpoint
#   make a FRESH=1        gives up a solve that was stopped, and begins anew
#   make a THREADS=1      threads of a solve (with `make -j4`, let -j and THREADS share the cores)
#   make a MPM_FLAGS='--set mesh.parameters.h=0.2'

MPM   ?= mpm
CASES ?= $(patsubst %/case.yaml,%,$(wildcard cases/*/case.yaml))

# Where the program is a file, or is built by a target MPM_BUILD, a new one makes every result stale.
mpm_program := $(or $(MPM_BUILD),$(wildcard $(firstword $(MPM))))
mpm_solve_flags = $(if $(RESUME),--resume) $(if $(FRESH),--fresh) $(if $(THREADS),--threads $(THREADS))

# The .geo that a case names, relative to its folder.
mpm_geo = $(addprefix $(1)/,$(shell sed -n 's/.*\bgeo: *["'\'']\{0,1\}\([^]["'\'' ,}\#]*\).*/\1/p;/\bgeo:/q' $(1)/case.yaml))

# $(1): name of the case, $(2): its folder.
define mpm_rules
.PHONY: $(1) $(1)-mesh $(1)-seed $(1)-solve $(1)-export $(1)-clean
$(1) $(1)-export: $(2)/out/points.pvd
$(1)-mesh: $(2)/out/mesh.msh
$(1)-seed: $(2)/out/points.vtu
$(1)-solve: $(2)/out/.solved

$(2)/out/mesh.msh: $(2)/case.yaml $(call mpm_geo,$(2)) $(mpm_program)
	$(MPM) mesh $(2) $(MPM_FLAGS)
$(2)/out/points.vtu: $(2)/out/mesh.msh
	$(MPM) seed $(2) $(MPM_FLAGS)
# A solve that was stopped has left results, but not this.
$(2)/out/.solved: $(2)/out/points.vtu
	$(MPM) solve $(2) $$(mpm_solve_flags) $(MPM_FLAGS)
	@touch $$@
$(2)/out/points.pvd: $(2)/out/.solved
	$(MPM) export $(2) $(MPM_FLAGS)
$(1)-clean:
	rm -rf $(2)/out
endef

$(foreach case,$(CASES),$(eval $(call mpm_rules,$(notdir $(case)),$(case))))
