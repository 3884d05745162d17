(** The extracted check, with the forgeries of any certificate (forgeries.v), for ../extracted/test.ml. *)
From mathcomp Require Import all_ssreflect.
From Isostat Require Import load_certificate.
From Data Require integers_in_zarith.
From Data Require Import extract forgeries.

Definition forged := forgeries.forgeries.
Extraction "checker.ml" load_check statement vertex_of solution_of claim_of end_of certificate_of genuine forged.
