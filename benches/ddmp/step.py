"""Load steps of a body on a grid that is restored in every step."""
from grid import *
import time
def face_mats(mesh,fs,c1,c2):
    g=c1*mesh.g1[fs]+c2*mesh.g2[fs]; n=mesh.gn[fs]
    r=np.repeat(n,12,axis=1).ravel(); c=np.tile(n,(1,12)).ravel(); v=g.ravel()
    return sp.csr_matrix((np.r_[v,v],(np.r_[2*r,2*r+1],np.r_[2*c,2*c+1])),shape=(2*mesh.nn,)*2)
@nb.njit(cache=True)
def sdist(Q,P,poly):
    n=Q.shape[0]; out=np.zeros(n)
    for i in range(n):
        d=1e300
        for k in range(P.shape[0]-1):
            ax=P[k,0];ay=P[k,1];bx=P[k+1,0]-ax;by=P[k+1,1]-ay
            t=((Q[i,0]-ax)*bx+(Q[i,1]-ay)*by)/(bx*bx+by*by); t=min(1.,max(0.,t))
            q=(Q[i,0]-ax-t*bx)**2+(Q[i,1]-ay-t*by)**2
            if q<d: d=q
        ins=False; m=poly.shape[0]; j=m-1
        for k in range(m):
            if (poly[k,1]>Q[i,1])!=(poly[j,1]>Q[i,1]):
                if Q[i,0]<(poly[j,0]-poly[k,0])*(Q[i,1]-poly[k,1])/(poly[j,1]-poly[k,1])+poly[k,0]: ins=not ins
            j=k
        out[i]=np.sqrt(d)*(1. if ins else -1.)
    return out
class Markers:
    '''free boundary polyline from base point to the symmetry/top end, moved with the grid'''
    def __init__(s,P): s.P=P.copy()
    def __call__(s,mesh,x,Vn):
        a,b=s.P[0],s.P[-1]
        poly=np.vstack([s.P,[[-9.,b[1]],[-9.,-9.],[a[0],-9.]]])
        return sdist(mesh.X,s.P,poly)+1e-12
    def advect(s,mesh,U,act):
        el,L=mesh.locate(s.P); ac=np.where(act)[0]
        for i in np.where(~act[el])[0]:
            e=ac[np.argmin(((mesh.cent[ac]-s.P[i])**2).sum(1))]; el[i]=e; L[i]=mesh.L0[e]+mesh.gL[e]@s.P[i]
        s.P=s.P+np.einsum('pa,pai->pi',mesh.N(L),U[mesh.T[el]])
def run(mesh,xp,V0,rho,grav,E,nu,fixed,steps,scheme,geom='none',ytop_fn=None,g1=0.1,g2=0.1,lo=0.05,hi=20.,soft=1,maxq=6,restore=True,agg=True,tol=1e-9,maxit=25,smooth=1,cb=None,verbose=0,minpts=4,gall=0.,ring=True,merge=0,spread=0):
    """scheme plain|ddmp|fit ; geom none(cut cells V_p) | fn:level set phi(X) | contour"""
    Lam=E*nu/(1+nu)/(1-2*nu); G=E/2/(1+nu); n=len(xp); nd=2*mesh.nn
    F=np.tile(np.eye(2),(n,1,1)); m=rho*V0; x=xp.copy(); ref=rho*abs(grav)*(np.ptp(xp[:,1]))
    its=0; stats=dict(deg=[],lost=[],halve=0,area=[]); ug=np.zeros(nd); t0=time.time()
    sub=mesh.sub; ident=np.arange(mesh.ne)
    fullM,_=moments(mesh.X,mesh.T,sub,np.ones(mesh.nn),ident,mesh.cent,mesh.sc)
    fixm=np.zeros(nd,bool); fixm[fixed]=True
    s=0; lcur=0.; dlam=1/steps
    while lcur<1-1e-9:
        if restore or s==0:
            el,L=mesh.locate(x); L=np.clip(L,0,1); L/=L.sum(1,keepdims=True)
            order,start=csr_cells(el,mesh.ne); cnt=np.diff(start); act=cnt>0
            J=np.linalg.det(F); Vn=V0*J
            mesh.shiftw=Vn; mesh.cutinfo(act)
            B=mesh.ops(el,L,scheme,act); N=mesh.N(L)
            # geometry
            if geom=='none':
                av=np.zeros(mesh.nv,bool); av[mesh.T[~act,:3].ravel()]=True
                cut=act&av[mesh.T[:,:3]].any(1); vol=np.where(act,mesh.A,0); M=fullM
            else:
                owner=np.where(act,ident,-1)
                if geom=='contour':
                    if spread:
                        # each point's initial square parcel, deformed by F, as spread x spread sub-points
                        o=(np.arange(spread)+.5)/spread-.5; ox,oy=np.meshgrid(o,o); off=np.c_[ox.ravel(),oy.ravel()]
                        xs=(x[:,None,:]+np.einsum('pij,qj->pqi',F,off)*np.sqrt(V0)[:,None,None]).reshape(-1,2)
                        lo_,hi_=mesh.X.min(0),mesh.X.max(0); xs=np.where(xs<lo_,2*lo_-xs,xs); xs=np.where(xs>hi_,2*hi_-xs,xs)
                        es,Ls=mesh.locate(xs); Ls=np.clip(Ls,0,1); phi=fillfrac(mesh.X,mesh.T,sub,es,Ls,np.repeat(Vn/len(off),len(off)),mesh.nn,smooth)
                    else: phi=fillfrac(mesh.X,mesh.T,sub,el,L,Vn,mesh.nn,smooth)
                    c=level(mesh,phi,Vn.sum(),ident); phi=phi-c
                else: phi=geom(mesh,x,Vn)
                _,vol=moments(mesh.X,mesh.T,sub,phi,ident,mesh.cent,mesh.sc)
                if agg:
                    for e in np.where((~act)&(vol>1e-12*mesh.A))[0]:
                        nb_=mesh.nbr[e]; nb_=nb_[nb_>=0]; nb_=nb_[act[nb_]]
                        if len(nb_): owner[e]=nb_[cnt[nb_].argmax()]
                merged=np.zeros(mesh.ne,bool)
                if merge:
                    for e in np.where(act&(vol<(1-1e-9)*mesh.A)&(cnt<merge))[0]:
                        nb_=mesh.nbr[e]; nb_=nb_[nb_>=0]; nb_=nb_[act[nb_]&(cnt[nb_]>=max(merge,cnt[e]+1))]
                        if len(nb_): owner[e]=nb_[cnt[nb_].argmax()]; merged[e]=True
                    for e in np.where((owner>=0)&(~act))[0]:
                        if merged[owner[e]]: owner[e]=owner[owner[e]]
                M,_=moments(mesh.X,mesh.T,sub,phi,owner,mesh.cent,mesh.sc)
                lost=vol[owner<0].sum()/max(vol.sum(),1e-300); stats['lost'].append(lost)
                cut=act&((vol<(1-1e-9)*mesh.A))
                cut|=act&(cnt<minpts)
            if scheme.startswith('fit'):
                do=(act&~cut) if geom=='none' else (act&(M[:,0]>1e-8*mesh.A))
                w,deg=fit_all(order,start,x,Vn,mesh.cent,mesh.sc,mesh.A,M,do.astype(np.int64),maxq,lo,hi,soft)
                stats['deg'].append([ (deg[act&~cut]==q).sum() for q in(6,5,3,2,1)]+[(deg[cut]==q).sum() for q in(6,5,3,2,1)])
                cut=cut|(act&(deg<=2)&(do>0))
                if merge: w[merged[el]]=1e-6*Vn[merged[el]]; cut|=merged
            else: w=mesh.weights(el,Vn)
            cut=cut|(act&(cnt<minpts))
            if mesh.basis=='dbub': mesh.pw=w; B=mesh.ops(el,L,scheme if scheme=='ddmp' else 'ddmp',act); mesh.pw=None
            if mesh.shift: mesh.usew=w; B=mesh.shifted(B,el,w)
            stats['area'].append(w.sum()/Vn.sum())
            # D operator
            c0=B[0].tocoo(); c1=B[1].tocoo(); rr=[];cc=[];vv=[]
            for i in(0,1):
                for j,cx in((0,c0),(1,c1)): rr.append(cx.row*4+2*i+j);cc.append(2*cx.col+i);vv.append(cx.data)
            D=sp.csr_matrix((np.concatenate(vv),(np.concatenate(rr),np.concatenate(cc))),shape=(4*n,nd)); DT=D.T.tocsr()
            usedn=np.zeros(mesh.nn,bool); usedn[c0.col]=True
            if scheme=='ddmp': usedn[:]=False; usedn[mesh.T[act].ravel()]=True
            free=np.repeat(usedn,2)&~fixm; fr=np.where(free)[0]
            Nn=sp.csr_matrix((N.ravel(),(np.repeat(np.arange(n),6),mesh.T[el].ravel())),shape=(n,mesh.nn))
            fb=np.zeros(nd); fb[1::2]=-grav*(Nn.T@(m/Vn*w)); w0=w/J
            actx=act.copy()
            if ring:
                f=mesh.fe; actx[f[cut[f[:,0]],1]]=True; actx[f[cut[f[:,1]],0]]=True
            fs=np.where(actx[mesh.fe].all(1)&(cut|(actx&~act))[mesh.fe].any(1)&act[mesh.fe].any(1))[0]
            usedn[mesh.T[mesh.fe[fs]].ravel()]=True
            free=np.repeat(usedn,2)&~fixm; fr=np.where(free)[0]
            Ks=face_mats(mesh,fs,g1*E,g2*E) if len(fs) and (g1>0 or g2>0) else sp.csr_matrix((nd,nd))
            if gall>0:
                fa=np.where(act[mesh.fe].all(1)&~cut[mesh.fe].any(1))[0]; Ks=Ks+face_mats(mesh,fa,gall*E,gall*E)
            Fn=F
        u=np.zeros(nd) if restore else ug.copy()
        def state(u):
            H=(D@u).reshape(n,2,2); dF=np.eye(2)+H; return dF
        ok=False; lam=lcur+dlam
        scale=np.abs(fb).sum()/max(len(fr),1)
        def resid(u,tang=False):
            dF=state(u)
            if not np.isfinite(dF).all() or np.linalg.det(dF).min()<0.05: return None
            Ft=dF@Fn; tau,a=hencky(Ft,Lam,G); inv=np.linalg.inv(dF)
            P=np.zeros((n,4,4))
            for i in(0,1):
                for mm in (0,1):
                    for j in(0,1): P[:,2*i+j,2*i+mm]=inv[:,mm,j]
            fint=DT@((w0[:,None]*np.einsum('pab,pa->pb',P,tau.reshape(n,4))).ravel())+Ks@u
            r=(fb*lam-fint); r[~free]=0
            return r,P,a,dF
        R=resid(u); nr=np.abs(R[0]).max()/scale; why=''
        for it in range(maxit):
            r,P,a,dF=R
            if (it>0 and nr<tol): ok=True; break
            S=sp.bsr_matrix((w0[:,None,None]*(np.swapaxes(P,1,2)@a@P),np.arange(n),np.arange(n+1)),shape=(4*n,4*n)).tocsr()
            K=(DT@(S@D)+Ks)[fr][:,fr].tocsc()
            try:
                du=np.zeros(nd); du[fr]=spl.splu(K,permc_spec='COLAMD').solve(r[fr])
            except RuntimeError: why='singular'; break
            if not np.isfinite(du).all(): why='nan'; break
            al=1.; its+=1; best=None
            for ls in range(8):
                R2=resid(u+al*du)
                if R2 is not None:
                    n2=np.linalg.norm(R2[0])
                    if best is None or n2<best[0]: best=(n2,al,R2)
                    if n2<1.5*np.linalg.norm(r) or nr<1e-6: break
                al/=2
            if best is None: why='det'; break
            u=u+best[1]*du; R=best[2]; nr=np.abs(R[0]).max()/scale
            if verbose>1: print(s,it,nr,al)
        dF=R[3]
        if not ok and dlam>1/steps/9:
            dlam/=2; stats['halve']+=1; redo=True; continue
        if not ok: return dict(err=None,why='%s lam %.3f nr %.1e'%(why or 'noconv',lcur,nr),stats=stats)
        F=dF@Fn
        U=u.reshape(-1,2)
        if hasattr(geom,'advect'): geom.advect(mesh,U,act)
        if restore: x=x+Nn@U
        else: ug=u; x=xp+Nn@U
        lcur=lam; s+=1; dlam=min(1/steps,1-lcur) if abs((lcur*steps)%1)<1e-6 or abs((lcur*steps)%1-1)<1e-6 else min(dlam,1-lcur)
        if cb: cb(s,x,F)
    tau,_=hencky(F,Lam,G); J=np.linalg.det(F); sig=tau/J[:,None,None]
    return dict(err=0,x=x,F=F,sig=sig,its=its,stats=stats,time=time.time()-t0,u=ug)
