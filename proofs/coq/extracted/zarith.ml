(* Zarith's integers under another name: what Coq extracts has a module Z of its own. *)
include Z
