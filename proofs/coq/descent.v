(** Statement T10 (../descent.md), the parts that are algebra: first-order decrease, the pivot of the simplex method,
  and the
    uniqueness of the forces of an equilibrium among all vertices under small displacements. *)
From mathcomp Require Import all_ssreflect all_algebra.
From Isostat Require Import statics.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section FirstOrder.
Variables (F : realFieldType) (n : nat) (G : 'M[F]_n).
Hypothesis regular : G \in unitmx.

(** W = - load . q decreases in the opening of a contact that carries traction. *)
Theorem opening_a_traction_decreases_the_potential (load : 'rV[F]_n) (l0 : 'I_n) :
  forces G load 0 l0 < 0 -> - (load *m opening G l0) 0 0 < 0.
Proof. by move=> traction; rewrite power_of_opening // opprK. Qed.
End FirstOrder.

(** Small displacements: gaps h = g0 - A u, one row per pair, load w. *)
Section SmallDisplacements.
Variables (F : realFieldType) (m n : nat) (A : 'M[F]_(m, n)) (g0 : 'cV[F]_m) (load : 'rV[F]_n).
Definition gaps (u : 'cV[F]_n) := g0 - A *m u.
Definition admissible (u : 'cV[F]_n) := forall l, 0 <= gaps u l 0.
(** Equilibrium under Signorini's conditions: compressive forces that balance the load,
  and only where the gap is closed. *)
Definition equilibrium (u : 'cV[F]_n) (f : 'rV[F]_m) :=
  [/\ admissible u, forall l, 0 <= f 0 l, f *m A = load & forall l, f 0 l * gaps u l 0 = 0].

Lemma work_is_constant_minus_openings f (x : 'cV_n) :
  f *m A = load -> (load *m x) 0 0 = (f *m g0) 0 0 - \sum_l f 0 l * gaps x l 0.
Proof.
move=> bal; have -> : \sum_l f 0 l * gaps x l 0 = (f *m gaps x) 0 0 by rewrite mxE.
have -> : load *m x = f *m g0 - f *m gaps x by rewrite /gaps mulmxBr mulmxA bal opprB addrC subrK.
by move: (f *m g0) (f *m gaps x) => y z; rewrite !mxE.
Qed.

(** An equilibrium does not depend on history: it maximises the work of the load among all admissible displacements. *)
Theorem equilibrium_is_optimal u f (u' : 'cV_n) :
  equilibrium u f -> admissible u' -> (load *m u') 0 0 <= (load *m u) 0 0.
Proof.
move=> [adm pos bal comp] adm'.
have work x := work_is_constant_minus_openings x bal.
have zero : \sum_l f 0 l * gaps u l 0 = 0 by apply: big1 => l _; exact: comp.
rewrite !work ler_add2l ler_opp2 zero; apply: sumr_ge0 => l _.
by rewrite mulr_ge0 ?pos ?adm'.
Qed.

(** Any two equilibria: each one's forces act only on pairs that are in contact in the other too. *)
Theorem equilibria_share_contacts u f u' f' :
  equilibrium u f -> equilibrium u' f' -> forall l, f 0 l * gaps u' l 0 = 0.
Proof.
move=> eq eq'; have [adm pos bal comp] := eq; have [adm' pos' bal' comp'] := eq'.
have work x := work_is_constant_minus_openings x bal.
have same : (load *m u') 0 0 = (load *m u) 0 0.
  by apply/eqP; rewrite eq_le (equilibrium_is_optimal eq adm') (equilibrium_is_optimal eq' adm).
have zero : \sum_l f 0 l * gaps u' l 0 = 0.
  move: same; rewrite !work => /addrI/oppr_inj ->.
  by apply: big1 => l _; exact: comp.
move=> l; move/eqP: zero; rewrite psumr_eq0 => [|i _]; last by rewrite mulr_ge0 ?pos ?adm'.
by move=> /allP/(_ l (mem_index_enum _))/eqP.
Qed.

(** Uniqueness: if the contacts that carry a positive force determine the displacement (k = 0 on the backbone),
  the displacement is unique. *)
Theorem equilibrium_displacement_is_unique u f u' f' :
  equilibrium u f -> equilibrium u' f' ->
  (forall v : 'cV_n, (forall l, 0 < f 0 l -> (A *m v) l 0 = 0) -> v = 0) -> u' = u.
Proof.
move=> eq eq' rigid; apply/eqP; rewrite -subr_eq0; apply/eqP; apply: rigid => l fl.
have [_ _ _ comp] := eq.
have g : gaps u l 0 = 0 by have /eqP := comp l; rewrite mulf_eq0 (gt_eqF fl) => /eqP.
have g' : gaps u' l 0 = 0.
  by have /eqP := equilibria_share_contacts eq eq' l; rewrite mulf_eq0 (gt_eqF fl) => /eqP.
have -> : (A *m (u' - u)) l 0 = gaps u l 0 - gaps u' l 0.
  have -> : A *m (u' - u) = gaps u - gaps u' by rewrite /gaps opprD opprK addrACA subrr add0r mulmxBr addrC.
  by move: (gaps u) (gaps u') => y z; rewrite !mxE.
by rewrite g g' subr0.
Qed.

(** The pivot of the simplex method: the motion that opens l0 at unit rate and keeps the other contacts with a force
  raises the work of the
    load in proportion to the length of the step, as long as the force in l0 is a traction. *)
Theorem pivot_increases_the_work (f : 'rV[F]_m) (u v : 'cV_n) (l0 : 'I_m) (t : F) :
  f *m A = load -> (forall l, l != l0 -> f 0 l != 0 -> (A *m v) l 0 = 0) -> (A *m v) l0 0 = -1 ->
  f 0 l0 < 0 -> 0 < t -> (load *m u) 0 0 < (load *m (u + t *: v)) 0 0.
Proof.
move=> bal kept unit traction t0.
have power : (load *m v) 0 0 = - f 0 l0.
  rewrite -bal -mulmxA mxE (bigD1 l0) //= unit mulrN1 big1 ?addr0 // => l nl.
  by case: (eqVneq (f 0 l) 0) => [->|fl]; rewrite ?mul0r // kept // mulr0.
rewrite mulmxDr -scalemxAr [X in _ < X]mxE ltr_addl [X in _ < X]mxE power.
by rewrite mulr_gt0 // oppr_gt0.
Qed.
End SmallDisplacements.

(** No structure comes back along a path on which the work of the load (minus the potential) increases: the path is
  finite. For the simplex
    method [T] are the bases, for arcs the isolated vertices. *)
Theorem increasing_work_repeats_nothing (F : realFieldType) (T : finType) (work : T -> F) (x : T) (path_of : seq T) :
  path (fun a b => work a < work b) x path_of -> uniq (x :: path_of) /\ (size path_of < #|T|)%N.
Proof.
move=> up; have distinct : uniq (x :: path_of).
  apply: (sorted_uniq _ _ (up : sorted _ (x :: path_of))) => [b a c|a]; [exact: lt_trans|by rewrite ltxx].
by split=> //; have := uniq_leq_size distinct (fun a _ => mem_enum T a); rewrite -cardE.
Qed.

Print Assumptions opening_a_traction_decreases_the_potential.
Print Assumptions equilibrium_is_optimal.
Print Assumptions equilibria_share_contacts.
Print Assumptions equilibrium_displacement_is_unique.
Print Assumptions pivot_increases_the_work.
Print Assumptions increasing_work_repeats_nothing.
